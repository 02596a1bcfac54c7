file(READ ${IN} hex HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes "${bytes}")
file(WRITE ${OUT} "#include <stddef.h>
extern const unsigned char abbe_embedded_${SYMBOL}[];
extern const size_t abbe_embedded_${SYMBOL}_size;
const unsigned char abbe_embedded_${SYMBOL}[] = {
${bytes}0};
const size_t abbe_embedded_${SYMBOL}_size = sizeof abbe_embedded_${SYMBOL} - 1;
")
