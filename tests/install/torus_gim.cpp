// torus_gim OUT.gim: the torus of radii 2 and 1 as a 33 x 33 geometry image, for the consumers to decode.
#include "codec/encode.h"

#include <cmath>
#include <fstream>
#include <numbers>

using namespace gimg::codec;

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    Source source;
    source.grid = 33;
    source.seam.lowest = 5;
    source.seam.sides = {
        {0, 4, GIM_SIDE_FIRST}, {1, 4, GIM_SIDE_FIRST}, {0, 4, GIM_SIDE_MATE}, {1, 4, GIM_SIDE_MATE}};
    std::vector<float> xyz;
    for (int j = 0; j < 33; ++j)
        for (int i = 0; i < 33; ++i) {
            const double u = 2 * std::numbers::pi * (i % 32) / 32, v = 2 * std::numbers::pi * (j % 32) / 32;
            const double rho = 2 + std::cos(v);
            for (const double x : {rho * std::cos(u), rho * std::sin(u), std::sin(v)})
                xyz.push_back(static_cast<float>(x));
        }
    source.xyz = xyz;

    const Outcome<Encoder> encoder = Encoder::prepare(source);
    if (!std::holds_alternative<Encoder>(encoder)) return 1;
    const Outcome<EncodedFile> file = std::get<Encoder>(encoder).encode({.coding = GIM_CODING_FLOAT});
    if (!std::holds_alternative<EncodedFile>(file)) return 1;
    const std::vector<std::uint8_t>& bytes = std::get<EncodedFile>(file).bytes;
    std::ofstream out(argv[1], std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return out.flush() ? 0 : 1;
}
