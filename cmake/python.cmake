# The Python module: python/papilla beside papilla/_native.so, built to <build>/python, so that PYTHONPATH=<build>/python finds
# it, and installed where Debian's Python looks (PAPILLA_PYTHON_DIR).
set(PYBIND11_FINDPYTHON ON)
set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The interpreter of the system: others may lack numpy")
find_package(Python COMPONENTS Interpreter Development.Module REQUIRED)
find_package(pybind11 REQUIRED)

file(GLOB bindings CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/python/bindings/*.cpp)
pybind11_add_module(papilla_python NO_EXTRAS ${bindings})
target_link_libraries(papilla_python PRIVATE papilla_options libpapilla)
target_include_directories(papilla_python PRIVATE ${CMAKE_SOURCE_DIR}/include)
if(PAPILLA_UNITY)
  target_precompile_headers(papilla_python PRIVATE ${CMAKE_SOURCE_DIR}/python/bindings/convert.h)
  set_target_properties(papilla_python PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 4)
endif()
# One module for every interpreter of this version: no name of the machine in it.
target_compile_options(papilla_python PRIVATE ${PAPILLA_TALKING_OPTIONS})
set_target_properties(papilla_python PROPERTIES OUTPUT_NAME _native LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python/papilla)

# The package itself is linked, not copied: an edit is seen at once.
file(GLOB package RELATIVE ${CMAKE_SOURCE_DIR}/python/papilla CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/python/papilla/*)
list(FILTER package EXCLUDE REGEX "__pycache__")
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/python/papilla)
foreach(file ${package})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/python/papilla/${file} ${CMAKE_BINARY_DIR}/python/papilla/${file} SYMBOLIC)
endforeach()

set(PAPILLA_PYTHON_DIR lib/python3/dist-packages CACHE STRING "Where the package is installed, below the prefix")
file(RELATIVE_PATH from_package ${CMAKE_INSTALL_PREFIX}/${PAPILLA_PYTHON_DIR}/papilla ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(papilla_python PROPERTIES INSTALL_RPATH "$ORIGIN/${from_package};$ORIGIN/../..")
install(TARGETS papilla_python LIBRARY DESTINATION ${PAPILLA_PYTHON_DIR}/papilla COMPONENT python)
install(DIRECTORY python/papilla DESTINATION ${PAPILLA_PYTHON_DIR} COMPONENT python PATTERN __pycache__ EXCLUDE)

# The pytest suite in two parts: ctest -L python.
if(PAPILLA_TESTS)
  set(environment "PYTHONPATH=${CMAKE_BINARY_DIR}/python;PYTHONDONTWRITEBYTECODE=1;OMP_WAIT_POLICY=passive;PAPILLA_PROGRAM=$<TARGET_FILE:papilla>")
  if(PAPILLA_SANITIZE)
    # The interpreter is not sanitized: it needs the sanitizer, and whose exceptions that watches, before all else. What
    # an interpreter keeps to its end is no leak of ours.
    foreach(library asan stdc++)
      execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${library}.so OUTPUT_VARIABLE file OUTPUT_STRIP_TRAILING_WHITESPACE)
      file(REAL_PATH ${file} file)
      list(APPEND preloaded ${file})
    endforeach()
    list(JOIN preloaded " " preloaded)
    list(APPEND environment "LD_PRELOAD=${preloaded}" "ASAN_OPTIONS=detect_leaks=0" "UBSAN_OPTIONS=print_stacktrace=1")
  endif()
  foreach(kind fast slow)
    if(kind STREQUAL slow)
      set(chosen slow)
    else()
      set(chosen "not slow")
    endif()
    add_test(NAME python_${kind} COMMAND ${Python_EXECUTABLE} -m pytest -q -m "${chosen}" --durations=5 ${CMAKE_SOURCE_DIR}/python/tests)
    set_tests_properties(python_${kind} PROPERTIES LABELS python_${kind} TIMEOUT 1800
      ENVIRONMENT "${environment}")
    if(kind STREQUAL slow)
      set_tests_properties(python_slow PROPERTIES COST 100)
    endif()
  endforeach()
endif()
