"""What scripts/torture does to the program, a module a kind of harm."""
