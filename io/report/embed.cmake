# cmake -DOUTPUT=x.cpp -DFILES="name=path;name=path" -P embed.cmake: each file becomes a std::string_view of that name
# in tumble::io::report, so the program needs no files beside it.
set(text "// Made by io/report/embed.cmake.\n#include \"io/report/embedded.h\"\n\nnamespace tumble::io::report {\n")
foreach(pair IN LISTS FILES)
  string(REGEX MATCH "^([a-z_]+)=(.*)$" _ "${pair}")
  set(name ${CMAKE_MATCH_1})
  file(READ "${CMAKE_MATCH_2}" bytes HEX)
  string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${bytes}")
  string(APPEND text "namespace {\nconst char ${name}_bytes[] = {\n${bytes}};\n}\n"
                     "const std::string_view ${name}{${name}_bytes, sizeof ${name}_bytes};\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}}\n")
