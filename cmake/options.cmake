add_library(papilla_options INTERFACE)
target_include_directories(papilla_options INTERFACE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/src)
# psabi: packs of 64 bytes are passed in other registers on processors without AVX-512; one build compiles both sides.
target_compile_options(papilla_options INTERFACE -Wall -Wextra -Wshadow -Wconversion
                                                 -Wno-sign-conversion -Wno-psabi)
target_compile_definitions(papilla_options INTERFACE PAPILLA_VERSION="${PROJECT_VERSION}"
                           # Eigen's memory as in Debian's Ceres and pagmo: with wider instructions it
                           # would align, and free, differently from them.
                           EIGEN_DONT_VECTORIZE EIGEN_MAX_ALIGN_BYTES=16
                           EIGEN_MAX_STATIC_ALIGN_BYTES=16)
# The compiler clears up its own memory when it has a gigabyte: a tenth of its time, for a quarter more memory.
target_compile_options(papilla_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
# A program loads what it calls, not what its layers might.
target_link_options(papilla_options INTERFACE LINKER:--as-needed)
if(PAPILLA_WARNINGS_AS_ERRORS)
  target_compile_options(papilla_options INTERFACE -Werror)
endif()
# What a file of a stranger could make of a mistake of ours ends the program instead. -O3 is the least that _FORTIFY_SOURCE
# takes; under the sanitizers it would hide what they look for.
target_compile_options(papilla_options INTERFACE -fstack-protector-strong)
target_compile_definitions(papilla_options INTERFACE _GLIBCXX_ASSERTIONS)
target_link_options(papilla_options INTERFACE LINKER:-z,relro,-z,now)
if(NOT PAPILLA_SANITIZE AND NOT PAPILLA_FUZZERS)
  # Of tests, which are not optimised, it could not be asked.
  set(optimised $<NOT:$<OR:$<CONFIG:Debug>,$<BOOL:$<TARGET_PROPERTY:PAPILLA_NOT_INSTALLED>>>>)
  target_compile_options(papilla_options INTERFACE $<${optimised}:-D_FORTIFY_SOURCE=2>)
endif()
# The name of a file in the message of a failed check is that below the source, not the builder's. Tests keep the whole one.
set(distributed $<AND:$<CONFIG:Release>,$<NOT:$<BOOL:$<TARGET_PROPERTY:PAPILLA_NOT_INSTALLED>>>>)
target_compile_options(papilla_options INTERFACE $<${distributed}:-ffile-prefix-map=${CMAKE_SOURCE_DIR}/=>)
if(PAPILLA_FUZZERS)
  target_compile_options(papilla_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined
                         -fno-sanitize-recover=undefined)
  target_link_options(papilla_options INTERFACE -fsanitize=address,undefined)
elseif(PAPILLA_SANITIZE)
  target_compile_options(papilla_options INTERFACE -fsanitize=address,undefined
                         -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(papilla_options INTERFACE -fsanitize=address,undefined)
  # Under the sanitizer Eigen pads its blocks; the libraries that share its matrices with us do not.
  target_compile_definitions(papilla_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
elseif(PAPILLA_NATIVE)
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-march=native PAPILLA_HAS_MARCH_NATIVE)
  if(PAPILLA_HAS_MARCH_NATIVE)
    target_compile_options(papilla_options INTERFACE -march=native)
    # GCC 12.2 with AVX-512 stores 1 in place of the 0 here (docs/decisions, 15).
    include(CheckCXXSourceRuns)
    set(CMAKE_REQUIRED_FLAGS "-O3 -march=native")
    check_cxx_source_runs("
      #include <vector>
      __attribute__((noinline)) std::vector<double> list() { return {1, 1, 1, 0}; }
      int main() { return list()[3] != 0; }" PAPILLA_LISTS_ARE_STORED_RIGHT)
    unset(CMAKE_REQUIRED_FLAGS)
    if(NOT PAPILLA_LISTS_ARE_STORED_RIGHT)
      target_compile_options(papilla_options INTERFACE -fno-tree-slp-vectorize)
    endif()
  endif()
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -fno-math-errno")
