# Debian 12 packages only (scripts/setup installs them).
# What the library itself links: who links the static one finds it by PapillaConfig.cmake.
set(PAPILLA_LIBRARY_PACKAGES PkgConfig OpenMP Eigen3 fmt nlohmann_json pugixml ZLIB)
set(PAPILLA_LIBRARY_MODULES fftw3 libzip libmd nlopt_cxx)  # of pkg-config
foreach(package IN LISTS PAPILLA_LIBRARY_PACKAGES)
  find_package(${package} REQUIRED)
endforeach()
foreach(module IN LISTS PAPILLA_LIBRARY_MODULES)
  pkg_check_modules(${module} REQUIRED IMPORTED_TARGET ${module})
endforeach()
# What its modules link, which are loaded as they are.
find_package(Ceres REQUIRED)
find_package(Pagmo REQUIRED)
find_package(OpenImageIO REQUIRED)
# Debian's package names the headers of OpenCV, which it neither needs here nor depends on.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER oiio_includes EXCLUDE REGEX opencv)
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_includes}")
if(PAPILLA_MPI)
  find_package(MPI COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    set(PAPILLA_MPI_LIBRARY MPI::MPI_CXX)
  else()
    message(STATUS "No MPI found (Debian: libopenmpi-dev): papilla optimize will run on one machine only")
  endif()
endif()
# What the program alone links.
find_package(CLI11 REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(httplib REQUIRED IMPORTED_TARGET cpp-httplib)
