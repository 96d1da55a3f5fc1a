#include "embree_scene.h"

#include <new>

namespace gimg {

EmbreeScene::EmbreeScene(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                         unsigned sceneFlags)
    : device_(rtcNewDevice(nullptr))
{
    if (!device_) throw std::bad_alloc();
    const std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseEmbree<rtcReleaseGeometry>> geometry(
        rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), faces.size()));
    if (!vertices || !indices) throw std::bad_alloc();
    for (const Vec3& p : positions)
        for (double x : p) *vertices++ = static_cast<float>(x);
    for (const Triangle& t : faces)
        for (int v : t) *indices++ = static_cast<unsigned>(v);
    rtcCommitGeometry(geometry.get());
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | sceneFlags));
    rtcAttachGeometry(scene_.get(), geometry.get());
    rtcCommitScene(scene_.get());
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw std::bad_alloc();
}

} // namespace gimg
