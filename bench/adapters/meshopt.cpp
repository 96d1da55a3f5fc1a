// Simplification by Lindstrom and Turk, then meshoptimizer's codecs and zstd: the peer that decodes fastest.
#include "mesh_peer.h"
#include "meshopt_codec.h"

namespace gimg::adapter {

std::unique_ptr<Adapter> makeAdapter()
{
    const Description description = {"meshopt",   "Lindstrom-Turk + meshoptimizer + zstd",
                                     Input::Mesh, Side::Peer,
                                     "meshopt",   {"libcgal-dev", "libmeshoptimizer-dev", "libzstd-dev"},
                                     {},          false};
#ifdef GIMG_MISSING
    return makeMissing(description, {GIMG_MISSING});
#else
    return makeMeshPeer({description, lindstromTurkLadder, meshoptCodec(), timeMeshopt});
#endif
}

} // namespace gimg::adapter
