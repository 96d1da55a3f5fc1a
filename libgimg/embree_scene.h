#pragma once

#include "gimg/mesh.h"

#include <embree3/rtcore.h>

#include <memory>
#include <type_traits>
#include <vector>

namespace gimg {

template <auto release> struct ReleaseEmbree
{
    template <class T> void operator()(T* object) const { release(object); }
};

/// Triangles in a tree of Embree's, robust, with float coordinates. Owns its device.
class EmbreeScene
{
public:
    EmbreeScene() = default;
    /// Throws std::bad_alloc where Embree fails.
    /// @param positions  within the range of floats
    EmbreeScene(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                unsigned sceneFlags = RTC_SCENE_FLAG_NONE);

    RTCScene get() const { return scene_.get(); }

private:
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseEmbree<rtcReleaseDevice>> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseEmbree<rtcReleaseScene>> scene_;
};

} // namespace gimg
