#include "ladder.h"

#include <meshoptimizer.h>

#include <limits>
#include <optional>

namespace gimg::adapter {
namespace {

class Meshopt : public Ladder
{
public:
    explicit Meshopt(const Mesh& mesh) : whole_(referenced(mesh))
    {
        for (const Vec3& p : whole_.positions)
            for (const double x : p) positions_.push_back(static_cast<float>(x));
        for (const Triangle& face : whole_.faces)
            for (const int v : face) indices_.push_back(static_cast<unsigned>(v));
        counts_ = rungCounts(whole_.faces.size());
        if (counts_.empty()) counts_.push_back(whole_.faces.size());
        rungs_.resize(counts_.size());
        rungs_[0] = whole_;
    }

    int size() const override { return static_cast<int>(rungs_.size()); }

    const Mesh& rung(int i) override
    {
        if (!rungs_[i]) rungs_[i] = simplified(counts_[i]);
        return *rungs_[i];
    }

    std::vector<Mesh> between(int i) override
    {
        std::vector<Mesh> meshes;
        for (const std::size_t count : countsBetween(counts_[i], counts_[i + 1]))
            meshes.push_back(simplified(count));
        return meshes;
    }

private:
    Mesh simplified(std::size_t triangles) const
    {
        std::vector<unsigned> kept(indices_.size());
        kept.resize(meshopt_simplify(kept.data(), indices_.data(), indices_.size(), positions_.data(),
                                     whole_.positions.size(), 3 * sizeof(float), 3 * triangles,
                                     std::numeric_limits<float>::max(), 0, nullptr));
        Mesh mesh;
        mesh.positions = whole_.positions;
        for (std::size_t i = 0; i + 2 < kept.size(); i += 3)
            mesh.faces.push_back(
                {static_cast<int>(kept[i]), static_cast<int>(kept[i + 1]), static_cast<int>(kept[i + 2])});
        return referenced(mesh);
    }

    Mesh whole_;
    std::vector<float> positions_;
    std::vector<unsigned> indices_;
    std::vector<std::size_t> counts_;
    std::vector<std::optional<Mesh>> rungs_;
};

} // namespace

Result<std::unique_ptr<Ladder>> meshoptLadder(const Mesh& mesh, std::size_t)
{
    return std::unique_ptr<Ladder>(std::make_unique<Meshopt>(mesh));
}

} // namespace gimg::adapter
