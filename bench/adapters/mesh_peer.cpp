#include "mesh_peer.h"

#include <algorithm>
#include <utility>

namespace gimg::adapter {
namespace {

// No coder here needs fewer bits for a triangle; rungs above are not worth making.
constexpr double kFewestBitsATriangle = 2;

class SimplifyAndCode : public Adapter
{
public:
    explicit SimplifyAndCode(MeshPeer peer) : peer_(std::move(peer)) {}

    Description describe() const override { return peer_.description; }

    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        const double bits = 8.0 * static_cast<double>(*std::max_element(sizes.begin(), sizes.end()));
        const Result<std::unique_ptr<Ladder>> ladder =
            peer_.simplify(subject.mesh, static_cast<size_t>(bits / kFewestBitsATriangle));
        if (!ladder) return ladder.error();
        return bestForSizes(**ladder, peer_.codec, sizes, subject.threads, done);
    }

    Result<Times> time(const Subject& subject, size_t, int runs) override
    {
        return peer_.time(subject.mesh, runs);
    }

private:
    MeshPeer peer_;
};

class Missing : public Adapter
{
public:
    explicit Missing(Description description) : description_(std::move(description)) {}

    Description describe() const override { return description_; }
    Status encode(const Subject&, const std::vector<size_t>&,
                  const std::function<void(size_t, Result<Coded>)>&) override
    {
        return notBuilt();
    }
    Result<Times> time(const Subject&, size_t, int) override { return notBuilt(); }

private:
    Error notBuilt() const { return {ErrorKind::CodecFailure, description_.name + " is not built"}; }

    Description description_;
};

} // namespace

std::unique_ptr<Adapter> makeMeshPeer(MeshPeer peer)
{
    return std::make_unique<SimplifyAndCode>(std::move(peer));
}

std::unique_ptr<Adapter> makeMissing(Description description, std::vector<std::string> missing)
{
    description.missing = std::move(missing);
    return std::make_unique<Missing>(std::move(description));
}

} // namespace gimg::adapter
