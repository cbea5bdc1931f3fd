# papilla_library(NAME FOLDER... LIBS target...): every .cpp of the folders, one library.
function(papilla_library name)
  cmake_parse_arguments(ARG "" "" "LIBS" ${ARGN})
  set(sources)
  foreach(folder ${ARG_UNPARSED_ARGUMENTS})
    file(GLOB found CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES OUTPUT_NAME papilla)
  target_link_libraries(${name} PUBLIC papilla_options ${ARG_LIBS})
endfunction()

# papilla_embed(module OUT name file ...): each file becomes `extern const std::string_view name` in namespace papilla.
function(papilla_embed module out)
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
    COMMAND ${CMAKE_COMMAND} -DOUT=${source} "-DSPEC=${spec}" -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake)
  target_sources(${module} PRIVATE ${source})
endfunction()
