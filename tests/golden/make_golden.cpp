#include "../codec/sample_images.h"

#include <fstream>
#include <iostream>

// Writes the golden files of a format version into the folder named on the command line. They are made
// once, and kept: a later version of the encoder may write other bytes, but every decoder must read these.
namespace {

using namespace gimg::codec;

void write(const std::string& folder, const std::string& name, const std::vector<std::uint8_t>& bytes)
{
    std::ofstream(folder + "/" + name + ".gim", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    std::cout << name << ' ' << bytes.size() << '\n';
}

Source sourceOf(const std::vector<float>& xyz, std::uint32_t grid, const Seam& seam)
{
    Source source;
    source.grid = grid;
    source.seam = seam;
    source.xyz = xyz;
    return source;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return std::cerr << "usage: make_golden FOLDER\n", 2;
    const std::string folder = argv[1];
    const std::vector<float> bumpy = samples::bumpyImage(65, 1), small = samples::bumpyImage(3, 2),
                             torus = samples::torusImage(33);
    const std::vector<float> normals = samples::torusNormals(65);

    const Source genus3 = sourceOf(bumpy, 65, samples::closedSeam(3, 33, 50));
    write(folder, "v1-wavelet-genus3", samples::encoded(genus3, {GIM_CODING_WAVELET, 0.004f, 0}));
    write(folder, "v1-wavelet-coarse-step", samples::encoded(genus3, {GIM_CODING_WAVELET, 0.3f, 0}));
    write(folder, "v1-wavelet-fine-step", samples::encoded(genus3, {GIM_CODING_WAVELET, 2e-6f, 0}));
    write(folder, "v1-12bit-genus3", samples::encoded(genus3, {GIM_CODING_RAW12, 0, 0}));
    write(folder, "v1-float-genus3", samples::encoded(genus3, {GIM_CODING_FLOAT, 0, 0}));
    write(folder, "v1-float-3x3-disk",
          samples::encoded(sourceOf(small, 3, samples::diskSeam(3)), {GIM_CODING_FLOAT, 0, 0}));
    // Floats of all magnitudes, among them some below the normal ones, and zeros of both signs.
    const std::vector<float> wild = samples::wildImage(33, 4);
    write(folder, "v1-float-wild",
          samples::encoded(sourceOf(wild, 33, samples::torusSeam(9)), {GIM_CODING_FLOAT, 0, 0}));
    write(folder, "v1-wavelet-3x3-disk",
          samples::encoded(sourceOf(small, 3, samples::diskSeam(3)), {GIM_CODING_WAVELET, 0.01f, 0}));

    Source withNormals = sourceOf(torus, 33, samples::torusSeam(9));
    withNormals.normalGrid = 65;
    withNormals.normals = normals;
    write(folder, "v1-wavelet-torus-normals",
          samples::encoded(withNormals, {GIM_CODING_WAVELET, 0.01f, 0.05f}));
    write(folder, "v1-12bit-torus-normals", samples::encoded(withNormals, {GIM_CODING_RAW12, 0, 0}));
    write(folder, "v1-float-torus-normals", samples::encoded(withNormals, {GIM_CODING_FLOAT, 0, 0}));

    Source boundary =
        sourceOf(bumpy, 65, {17, 5, {{0, 12, 1}, {1, 10, 0}, {2, 8, 1}, {0, 12, 2}, {2, 8, 2}, {3, 14, 0}}});
    write(folder, "v1-12bit-boundary", samples::encoded(boundary, {GIM_CODING_RAW12, 0, 0}));
    write(folder, "v1-wavelet-boundary", samples::encoded(boundary, {GIM_CODING_WAVELET, 0.02f, 0}));

    write(folder, "v1-surface-genus3", samples::encoded(genus3, {GIM_CODING_SURFACE, 0.004f, 0}));
    write(folder, "v1-surface-coarse-step", samples::encoded(genus3, {GIM_CODING_SURFACE, 0.3f, 0}));
    std::vector<std::uint8_t> fine = samples::encoded(genus3, {GIM_CODING_SURFACE, 2e-6f, 0});
    write(folder, "v1-surface-fine-step", fine);
    fine.resize(fine.size() / 3);
    write(folder, "v1-surface-prefix", fine);
    write(folder, "v1-surface-boundary", samples::encoded(boundary, {GIM_CODING_SURFACE, 0.02f, 0}));
    write(folder, "v1-surface-3x3-disk",
          samples::encoded(sourceOf(small, 3, samples::diskSeam(3)), {GIM_CODING_SURFACE, 0.01f, 0}));
    write(folder, "v1-surface-torus-normals",
          samples::encoded(withNormals, {GIM_CODING_SURFACE, 0.01f, 0.05f}));
    // Normals and attributes as fields: four channels glued, two open, and integers without loss.
    Source withFields = boundary;
    withFields.normalGrid = 65;
    withFields.normals = normals;
    samples::Dice dice(7);
    std::vector<float> colors, uv, bones;
    for (std::uint32_t k = 0; k < 65 * 65; ++k)
        for (unsigned c = 0; c < 4; ++c)
            colors.push_back(static_cast<float>(40 + 2 * (k % 65) + c * (k / 65) / 4 + dice.below(4)));
    for (std::uint32_t k = 0; k < 33 * 33; ++k)
        for (const std::uint32_t at : {k % 33, k / 33})
            uv.push_back(static_cast<float>(at * at) / 1024 + 0.01f * static_cast<float>(dice.unit()));
    for (std::uint32_t k = 0; k < 17 * 17; ++k) bones.push_back(static_cast<float>(dice.below(65536)));
    withFields.attributes = {{"color", 65, 4, GIM_U8, true, true, false, colors},
                             {"uv", 33, 2, GIM_F32, false, false, false, uv},
                             {"bones", 17, 1, GIM_U16, true, false, true, bones}};
    write(folder, "v1-fields", samples::encoded(withFields, {GIM_CODING_SURFACE, 0.02f, 0.05f, 0.01f}));

    // Each side folded onto itself, as an octahedron unfolds: glued down to the coarsest grid.
    const Source folded = sourceOf(
        bumpy, 65,
        {17, 0, {{0, 8, 1}, {0, 8, 2}, {1, 8, 1}, {1, 8, 2}, {2, 8, 1}, {2, 8, 2}, {3, 8, 1}, {3, 8, 2}}});
    write(folder, "v1-surface-folded", samples::encoded(folded, {GIM_CODING_SURFACE, 0.01f, 0}));
    return 0;
}
