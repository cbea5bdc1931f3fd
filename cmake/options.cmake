add_library(papilla_options INTERFACE)
target_include_directories(papilla_options INTERFACE ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/src)
target_compile_options(papilla_options INTERFACE -Wall -Wextra -Wshadow -Wconversion
                                                 -Wno-sign-conversion)
# g++ 12 reports its own AVX-512 intrinsics (GCC bug 105593).
target_compile_options(papilla_options INTERFACE -Wno-maybe-uninitialized)
target_compile_definitions(papilla_options INTERFACE PAPILLA_VERSION="${PROJECT_VERSION}"
                           PAPILLA_DESIGNS_DIR="${CMAKE_SOURCE_DIR}/designs"
                           PAPILLA_INSTALLED_DESIGNS_DIR="${CMAKE_INSTALL_PREFIX}/share/papilla/designs")
if(PAPILLA_WARNINGS_AS_ERRORS)
  target_compile_options(papilla_options INTERFACE -Werror)
endif()
if(PAPILLA_SANITIZE)
  target_compile_options(papilla_options INTERFACE -fsanitize=address,undefined
                         -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(papilla_options INTERFACE -fsanitize=address,undefined)
elseif(PAPILLA_NATIVE)
  include(CheckCXXCompilerFlag)
  check_cxx_compiler_flag(-march=native PAPILLA_HAS_MARCH_NATIVE)
  if(PAPILLA_HAS_MARCH_NATIVE)
    # Eigen's memory alignment depends on this flag: every target gets it, or none.
    target_compile_options(papilla_options INTERFACE -march=native)
  endif()
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -fno-math-errno")
