// Simplification by meshoptimizer, what users of gltfpack get, then Draco.
#include "draco_codec.h"
#include "mesh_peer.h"

namespace gimg::adapter {

std::unique_ptr<Adapter> makeAdapter()
{
    const Description description = {"draco-meshopt",
                                     "meshopt_simplify + Draco",
                                     Input::Mesh,
                                     Side::Peer,
                                     "draco",
                                     {"libmeshoptimizer-dev", "libdraco-dev"},
                                     {},
                                     false};
#ifdef GIMG_MISSING
    return makeMissing(description, {GIMG_MISSING});
#else
    return makeMeshPeer({description, meshoptLadder, dracoCodec(), timeDraco});
#endif
}

} // namespace gimg::adapter
