# The program, the library and what belongs to it, for programs (find_package(Papilla), pkg-config papilla) and people.
# Nothing of an installed tree names its own place: it may be moved.
include(CMakePackageConfigHelpers)
file(RELATIVE_PATH from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(papilla PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin}")

install(TARGETS papilla RUNTIME)
install(TARGETS libpapilla EXPORT papilla LIBRARY ARCHIVE)
install(TARGETS papilla_images LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/papilla)
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
else()
  install(FILES cmake/dependencies.cmake DESTINATION ${package})
endif()

install(CODE "
  set(shell \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/bash-completion/completions/papilla\")
  cmake_path(GET shell PARENT_PATH folder)
  file(MAKE_DIRECTORY \"\${folder}\")
  execute_process(COMMAND $<TARGET_FILE:papilla> completion bash OUTPUT_FILE \"\${shell}\" COMMAND_ERROR_IS_FATAL ANY)")
