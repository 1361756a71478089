# Turns the built page into a C++ constant: cmake -DINPUT=report.html -DOUTPUT=report_page.cpp -P embed.cmake
# Bytes rather than a string literal, because compilers limit the length of those.
file(READ ${INPUT} bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n"
       bytes "${bytes}")
file(WRITE ${OUTPUT}
  "#include <cstddef>\n"
  "namespace jamscope {\n"
  "extern const unsigned char report_page[];\n"
  "extern const std::size_t report_page_size;\n"
  "const unsigned char report_page[] = {\n${bytes}\n};\n"
  "const std::size_t report_page_size = ${size};\n"
  "}  // namespace jamscope\n")
