# Debian packages by CPack: cmake --preset package && cmake --build --preset package && cpack --config build/package/CPackConfig.cmake
# papilla (program, library, headers, designs, manuals), python3-papilla, papilla-doc. docs/how_to/packages.md
set(debian ${CMAKE_SOURCE_DIR}/cmake/debian)
set(doc ${CMAKE_INSTALL_DATADIR}/doc)

# What every package of Debian has: its licence and its changes, compressed.
find_program(PAPILLA_GZIP gzip REQUIRED)
set(changelog ${CMAKE_BINARY_DIR}/changelog)
configure_file(${debian}/changelog.in ${changelog} @ONLY)
execute_process(COMMAND ${PAPILLA_GZIP} -9nf ${changelog} COMMAND_ERROR_IS_FATAL ANY)
foreach(component papilla python doc)
  set(name_papilla papilla)
  set(name_python python3-papilla)
  set(name_doc papilla-doc)
  install(FILES ${debian}/copyright ${changelog}.gz DESTINATION ${doc}/${name_${component}} COMPONENT ${component})
endforeach()
# As in the source, so that the links between the pages hold, to the results that they show too.
install(DIRECTORY docs DESTINATION ${doc}/papilla-doc COMPONENT doc)
install(DIRECTORY results/accuracy results/gallery DESTINATION ${doc}/papilla-doc/results COMPONENT doc)
install(DIRECTORY python/examples DESTINATION ${doc}/papilla-doc COMPONENT doc)
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${doc}/papilla-doc COMPONENT doc)
install(CODE "
  file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1/*.1\")
  execute_process(COMMAND ${PAPILLA_GZIP} -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT papilla)

# In the system's own folders nobody is told where to look.
foreach(component papilla python)
  set(file_papilla ${CMAKE_INSTALL_BINDIR}/papilla)
  set(file_python ${PAPILLA_PYTHON_DIR}/papilla/$<TARGET_FILE_NAME:papilla_python>)
  install(CODE "file(RPATH_REMOVE FILE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${file_${component}}\")" COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME papilla)
set(CPACK_PACKAGE_VENDOR Papilla)
set(CPACK_PACKAGE_CONTACT "${PAPILLA_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL papilla python doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})

set(CPACK_DEBIAN_PAPILLA_PACKAGE_NAME papilla)
set(CPACK_DEBIAN_PAPILLA_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PAPILLA_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PAPILLA_PACKAGE_CONTROL_EXTRA ${debian}/triggers)
set(CPACK_DEBIAN_PAPILLA_PACKAGE_SUGGESTS "python3-papilla, papilla-doc")
set(CPACK_COMPONENT_PAPILLA_DESCRIPTION
"inverse design of surface textures for touch
Computes how a finger rubs on a textured surface over humidity, with and
without an electroadhesive voltage, with error bars; searches for the texture
that feels strongest and steadiest; writes heightmaps and masks for makers.

This package has the program, the C++ library with its headers, the designs
and the manual pages.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-papilla)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
math(EXPR next "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "papilla (= ${PROJECT_VERSION}), python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, python3-optuna")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${debian}/postinst;${debian}/prerm")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"inverse design of surface textures for touch (Python 3)
The Python module of Papilla: designs from files, dicts and numpy arrays,
friction over humidity with error bars, studies by ask and tell, ranking,
calibration and files for makers; pictures in notebooks.")

set(CPACK_DEBIAN_DOC_PACKAGE_NAME papilla-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_DOC_DESCRIPTION
"inverse design of surface textures for touch (documentation)
Tutorial, guides, theory with its equations, the reference of every key, and
notebooks of Papilla.")
include(CPack)
