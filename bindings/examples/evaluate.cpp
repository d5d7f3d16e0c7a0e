// Evaluates a BTF, from a file that is in memory.
#include "subsurf.h"
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <vector>

static void check(SubsurfStatus status) {
    if (status != SUBSURF_STATUS_OK) throw std::runtime_error(subsurf_last_error());
}

struct Close {
    void operator()(SubsurfFile *file) const { subsurf_file_close(file); }
};

int main(int, char **argv) try {
    std::ifstream stream(argv[1], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    SubsurfFile *opened = nullptr;
    check(subsurf_file_open_memory(bytes.data(), bytes.size(), &opened));
    const std::unique_ptr<SubsurfFile, Close> file(opened);  // goes before the bytes do
    check(subsurf_btf_expand(file.get()));                   // nothing to do for nested codebooks

    std::uint32_t texel = 0;
    check(subsurf_btf_texel(file.get(), 0, 0, 1, 1, &texel));
    const float light[3] = {0, 0, 1}, view[3] = {0.6f, 0, 0.8f};
    float value[3], rgb[3];
    check(subsurf_btf_eval(file.get(), texel, light, view, value));
    check(subsurf_btf_linear(file.get(), value, rgb));
    std::printf("linear RGB of texel %u: %g %g %g\n", static_cast<unsigned>(texel), rgb[0], rgb[1], rgb[2]);
    return 0;
} catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
