# cmake -DCATALOGUE=zh.mo -DSOURCE=zh_catalogue.cpp -P embed.cmake: the compiled catalogue as a part of the program.
file(READ ${CATALOGUE} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(................................................................................)" "\\1\n"
                     bytes "${bytes}")
file(WRITE ${SOURCE} "#include \"reports/words/internal/zh.h\"

namespace rondure::reports {
namespace {

constexpr unsigned char kChineseCatalogue[] = {
${bytes}
};

}  // namespace

std::span<const unsigned char> chinese_catalogue() { return kChineseCatalogue; }

}  // namespace rondure::reports
")
