// Stands for the headers in common.h, which the tests share compiled.
