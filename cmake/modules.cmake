# papilla_unity(TARGET FOLDER...): each room is compiled as one file, so that what its files all include is read once (half of the
# compiler's time, or less); preset dev compiles file by file, for whoever changes one at a time. Not the rooms below: there
# several files give different things the same name, or one is compiled with definitions of its own.
set(PAPILLA_ROOMS_BY_FILE src/base src/numerics geometry/io)
function(papilla_unity name)
  if(NOT PAPILLA_UNITY)
    return()
  endif()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(folder ${ARGN})
    if(NOT folder IN_LIST PAPILLA_ROOMS_BY_FILE)
      file(GLOB found CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
      string(REPLACE "/" "_" room ${folder})
      set_source_files_properties(${found} PROPERTIES UNITY_GROUP ${room})
    endif()
  endforeach()
endfunction()

# Rooms that read, arrange and print: what they take is the compiler's time, not the processor's (docs/architecture.md).
set(PAPILLA_ROOMS_THAT_TALK config design published lab rank calibrate claims measure cases report cli api)
set(PAPILLA_TALKING_OPTIONS $<$<CONFIG:Release>:-O1>)

# Loops over pixels run there, over arrays of their own: asserting each index costs a search a seventh of its time. Whoever
# reads what others wrote keeps the assertions.
set(PAPILLA_ROOMS_OF_LOOPS src/numerics geometry geometry/textures src/fields src/physics/contact src/physics/capillary src/physics/electrostatics
    src/physics/optics src/physics/optics/lattice src/physics/macro src/physics/drive src/physics/persson src/forward)

# papilla_library(NAME FOLDER... LIBS target...): every .cpp of the folders, one library. Other programs see its public
# headers alone; our own program and tests link papilla_inside, which adds the internal headers and what those include.
function(papilla_library name)
  cmake_parse_arguments(ARG "" "" "LIBS" ${ARGN})
  foreach(folder ${ARG_UNPARSED_ARGUMENTS})
    file(GLOB found CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
    cmake_path(GET folder FILENAME room)
    if(folder IN_LIST PAPILLA_ROOMS_OF_LOOPS)
      list(APPEND looping ${found})
    elseif(room IN_LIST PAPILLA_ROOMS_THAT_TALK)
      list(APPEND talking ${found})
    else()
      list(APPEND computing ${found})
    endif()
  endforeach()
  add_library(papilla_headers INTERFACE)
  target_include_directories(papilla_headers INTERFACE ${CMAKE_SOURCE_DIR}/include)
  target_link_libraries(papilla_headers INTERFACE papilla_options fmt::fmt OpenMP::OpenMP_CXX Eigen3::Eigen
                        nlohmann_json::nlohmann_json)
  add_library(papilla_talking OBJECT ${talking})
  target_compile_options(papilla_talking PRIVATE ${PAPILLA_TALKING_OPTIONS})
  target_compile_definitions(papilla_talking PRIVATE PAPILLA_INSIDE)  # include/papilla/names.h
  add_library(papilla_looping OBJECT ${looping})
  target_compile_options(papilla_looping PRIVATE -U_GLIBCXX_ASSERTIONS)
  add_library(${name} ${computing} $<TARGET_OBJECTS:papilla_talking> $<TARGET_OBJECTS:papilla_looping>)
  set_target_properties(${name} PROPERTIES OUTPUT_NAME papilla EXPORT_NAME papilla VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})  # no stable ABI before 1.0
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include>
                                            $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  foreach(part ${name} papilla_talking papilla_looping)
    papilla_unity(${part} ${ARG_UNPARSED_ARGUMENTS})
    if(PAPILLA_UNITY)
      target_precompile_headers(${part} PRIVATE ${CMAKE_SOURCE_DIR}/src/common.h)
    endif()
    target_link_libraries(${part} PRIVATE $<BUILD_INTERFACE:papilla_headers> ${ARG_LIBS})
    if(BUILD_SHARED_LIBS)  # calls within the library are direct, as in a static one
      target_compile_options(${part} PRIVATE -fno-semantic-interposition)
      set_target_properties(${part} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    endif()
  endforeach()
  if(BUILD_SHARED_LIBS)
    target_link_options(${name} PRIVATE LINKER:-Bsymbolic-functions)
  endif()

  add_library(papilla_inside INTERFACE)
  target_link_libraries(papilla_inside INTERFACE ${name} papilla_headers)
endfunction()

# papilla_module(NAME SOURCE LIBRARY): papilla_NAME.so beside the library, which loads it, and installed below it.
function(papilla_module name source library)
  add_library(papilla_${name} MODULE ${source})
  set_target_properties(papilla_${name} PROPERTIES PREFIX "")
  target_link_libraries(papilla_${name} PRIVATE papilla_options ${library})
  add_dependencies(libpapilla papilla_${name})
  install(TARGETS papilla_${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/papilla COMPONENT papilla)
endfunction()

# papilla_embed(module room OUT name file ...): each file becomes `extern const std::string_view name` in namespace papilla::room.
function(papilla_embed module room out)
  set(spec "")
  set(files "")
  while(ARGN)
    list(POP_FRONT ARGN name file)
    list(APPEND files ${file})
    list(APPEND spec "${name}=${file}")
  endwhile()
  list(JOIN spec "|" spec)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${out}.cpp)
  add_custom_command(OUTPUT ${source} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DOUT=${source} -DROOM=${room} "-DSPEC=${spec}" -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake)
  target_sources(${module} PRIVATE ${source})
endfunction()
