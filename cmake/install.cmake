# The program, the library and what belongs to it, for programs (find_package(Papilla), pkg-config papilla) and people.
# Nothing of an installed tree names its own place: it may be moved.
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME papilla)
file(RELATIVE_PATH from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(papilla PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin};$ORIGIN")

install(TARGETS papilla RUNTIME)
install(TARGETS libpapilla EXPORT papilla LIBRARY ARCHIVE)
install(DIRECTORY include/papilla TYPE INCLUDE)
install(DIRECTORY designs DESTINATION ${CMAKE_INSTALL_DATADIR}/papilla)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Papilla)
install(EXPORT papilla NAMESPACE Papilla:: FILE PapillaTargets.cmake DESTINATION ${package})
configure_package_config_file(cmake/PapillaConfig.cmake.in PapillaConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(PapillaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/PapillaConfig.cmake ${CMAKE_BINARY_DIR}/PapillaConfigVersion.cmake
        DESTINATION ${package})
if(BUILD_SHARED_LIBS)  # who links the static library needs the libraries behind it: CMake knows them
  file(RELATIVE_PATH PAPILLA_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(cmake/papilla.pc.in papilla.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/papilla.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()

# Made by the program itself from its own tables: completion of two shells and the manual pages.
install(CODE "
  set(data \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
  foreach(shell IN ITEMS bash fish)
    set(file \"\${data}/bash-completion/completions/papilla\")
    if(shell STREQUAL fish)
      set(file \"\${data}/fish/vendor_completions.d/papilla.fish\")
    endif()
    cmake_path(GET file PARENT_PATH folder)
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND $<TARGET_FILE:papilla> completion \${shell} OUTPUT_FILE \"\${file}\" COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
  execute_process(COMMAND $<TARGET_FILE:papilla> describe --manuals \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\" COMMAND_ERROR_IS_FATAL ANY)"
  COMPONENT papilla)
if(PAPILLA_PACKAGES)
  include(cmake/package.cmake)
endif()
