#include "bench_decode.h"

#include <chrono>
#include <cstring>

namespace gimg::gimrd {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Error refused(gim_status status) { return {ErrorKind::CodecFailure, gim_status_text(status)}; }

} // namespace

Result<GimDecoder> GimDecoder::open(std::vector<std::uint8_t> file)
{
    GimDecoder d;
    d.file_ = std::move(file);
    d.info_.size = sizeof d.info_;
    gim_status status = gim_probe(d.file_.data(), d.file_.size(), nullptr, &d.info_);
    if (status != GIM_OK) return refused(status);
    d.workspace_.resize(gim_workspace_size(&d.info_));
    d.counts_.size = sizeof d.counts_;
    status = gim_mesh_size(d.file_.data(), d.file_.size(), nullptr, 0, 0, d.workspace_.data(),
                           d.workspace_.size(), &d.counts_);
    if (status != GIM_OK) return refused(status);
    const size_t normals = size_t{d.info_.normal_grid} * d.info_.normal_grid;
    d.xyz_.resize(size_t{3} * d.info_.grid * d.info_.grid);
    d.positions_.resize(size_t{3} * d.counts_.vertices);
    d.normals_.resize(normals != 0 ? 3 * normals : d.xyz_.size());
    d.sampleOfVertex_.resize(d.counts_.vertices);
    d.triangles_.resize(size_t{3} * d.counts_.triangles);
    return d;
}

gim_status GimDecoder::decodeSamples()
{
    gim_info info{};
    info.size = sizeof info;
    const gim_status status = gim_probe(file_.data(), file_.size(), nullptr, &info);
    if (status != GIM_OK) return status;
    return gim_decode_geometry(file_.data(), file_.size(), nullptr, 0, workspace_.data(), workspace_.size(),
                               xyz_.data());
}

gim_status GimDecoder::buildMesh()
{
    gim_mesh_counts counts{};
    counts.size = sizeof counts;
    gim_status status = gim_mesh_size(file_.data(), file_.size(), nullptr, 0, 0, workspace_.data(),
                                      workspace_.size(), &counts);
    if (status != GIM_OK) return status;
    status = gim_build_mesh(file_.data(), file_.size(), nullptr, 0, 0, workspace_.data(), workspace_.size(),
                            xyz_.data(), nullptr, sampleOfVertex_.data(), triangles_.data());
    for (size_t v = 0; v < sampleOfVertex_.size(); ++v)
        std::memcpy(&positions_[3 * v], &xyz_[size_t{3} * sampleOfVertex_[v]], 3 * sizeof(float));
    return status;
}

gim_status GimDecoder::findNormals()
{
    if (info_.normal_grid != 0)
        return gim_decode_normals(file_.data(), file_.size(), nullptr, 0, workspace_.data(),
                                  workspace_.size(), normals_.data());
    return gim_estimate_normals(file_.data(), file_.size(), nullptr, 0, 0, workspace_.data(),
                                workspace_.size(), xyz_.data(), normals_.data());
}

Result<DecodeTimes> GimDecoder::run()
{
    DecodeTimes times;
    const Clock::time_point start = Clock::now();
    gim_status status = decodeSamples();
    if (status != GIM_OK) return refused(status);
    times.samples = millisecondsSince(start);
    status = buildMesh();
    if (status != GIM_OK) return refused(status);
    times.positions = millisecondsSince(start);
    status = findNormals();
    if (status != GIM_OK) return refused(status);
    times.all = millisecondsSince(start);
    return times;
}

std::size_t GimDecoder::outputBytes() const
{
    const size_t normalImage = size_t{3} * info_.normal_grid * info_.normal_grid;
    return (xyz_.size() + normalImage) * sizeof(float) +
           (sampleOfVertex_.size() + triangles_.size()) * sizeof(std::uint32_t);
}

Mesh GimDecoder::mesh() const
{
    Mesh mesh;
    mesh.positions.reserve(counts_.vertices);
    for (size_t k = 0; k + 2 < positions_.size(); k += 3)
        mesh.positions.emplace_back(positions_[k], positions_[k + 1], positions_[k + 2]);
    mesh.faces.reserve(counts_.triangles);
    for (size_t k = 0; k + 2 < triangles_.size(); k += 3)
        mesh.faces.push_back({static_cast<int>(triangles_[k]), static_cast<int>(triangles_[k + 1]),
                              static_cast<int>(triangles_[k + 2])});
    return mesh;
}

} // namespace gimg::gimrd
