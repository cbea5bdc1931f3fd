# cmake -DOUT=FILE.cpp -DROOM=report -DSPEC="name=file|name=file" -P embed.cmake: files as constants of namespace papilla::ROOM.
string(REPLACE "|" ";" entries "${SPEC}")
set(text "#include <string_view>\nnamespace papilla::${ROOM} {\n")
foreach(entry ${entries})
  string(REGEX MATCH "^([^=]+)=(.*)$" matched "${entry}")
  file(READ "${CMAKE_MATCH_2}" content)
  string(APPEND text "extern const std::string_view ${CMAKE_MATCH_1};\n"
                     "const std::string_view ${CMAKE_MATCH_1} = R\"papilla(${content})papilla\";\n")
endforeach()
string(APPEND text "}  // namespace papilla::${ROOM}\n")
file(WRITE "${OUT}" "${text}")
