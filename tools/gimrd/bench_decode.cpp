#include "bench_decode.h"

#include <chrono>
#include <cmath>
#include <cstring>

namespace gimg::gimrd {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

Error refused(gim_status status) { return {ErrorKind::CodecFailure, gim_status_text(status)}; }

// Area-weighted: the cross product of two edges is as long as twice the triangle's area.
void addFaceNormals(const std::vector<std::uint32_t>& triangles, const std::vector<float>& positions,
                    std::vector<float>& normals)
{
    for (size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const float* a = &positions[size_t{3} * triangles[t]];
        const float* b = &positions[size_t{3} * triangles[t + 1]];
        const float* c = &positions[size_t{3} * triangles[t + 2]];
        const float u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const float v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
        const float n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        for (size_t corner = 0; corner < 3; ++corner) {
            float* sum = &normals[size_t{3} * triangles[t + corner]];
            for (size_t k = 0; k < 3; ++k) sum[k] += n[k];
        }
    }
}

void normalize(std::vector<float>& normals)
{
    for (size_t k = 0; k + 2 < normals.size(); k += 3) {
        float* n = &normals[k];
        const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        if (!(length > 0)) continue;
        for (size_t c = 0; c < 3; ++c) n[c] /= length;
    }
}

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
    d.normals_.resize(3 * (normals != 0 ? normals : d.counts_.vertices));
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
    std::memset(normals_.data(), 0, normals_.size() * sizeof(float));
    addFaceNormals(triangles_, positions_, normals_);
    normalize(normals_);
    return GIM_OK;
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
