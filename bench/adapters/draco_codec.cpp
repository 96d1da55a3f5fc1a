// Draco stays in this file.
#include "draco_codec.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <string>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kSpeed = 0; ///< 10 less the compression level
constexpr int kTimedBits = 12;

Error failure(const draco::Status& status)
{
    return {ErrorKind::CodecFailure, std::string("draco: ") + status.error_msg()};
}

std::unique_ptr<draco::Mesh> toDraco(const Mesh& mesh)
{
    auto result = std::make_unique<draco::Mesh>();
    const auto vertices = static_cast<uint32_t>(mesh.positions.size());
    result->set_num_points(vertices);
    draco::GeometryAttribute layout;
    layout.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float),
                0);
    draco::PointAttribute* positions = result->attribute(result->AddAttribute(layout, true, vertices));
    for (uint32_t v = 0; v < vertices; ++v) {
        const Eigen::Vector3f position = mesh.positions[v].cast<float>();
        positions->SetAttributeValue(draco::AttributeValueIndex(v), position.data());
    }
    result->SetNumFaces(mesh.faces.size());
    for (uint32_t f = 0; f < mesh.faces.size(); ++f) {
        draco::Mesh::Face face;
        for (size_t k = 0; k < 3; ++k) face[k] = static_cast<uint32_t>(mesh.faces[f][k]);
        result->SetFace(draco::FaceIndex(f), face);
    }
    // As the reader of draco_encoder does.
    result->DeduplicateAttributeValues();
    result->DeduplicatePointIds();
    return result;
}

Result<Bytes> encodeDraco(const draco::Mesh& mesh, int bits)
{
    draco::Encoder encoder;
    encoder.SetSpeedOptions(kSpeed, kSpeed);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
    if (!status.ok()) return failure(status);
    return Bytes(buffer.data(), buffer.data() + buffer.size());
}

draco::StatusOr<std::unique_ptr<draco::Mesh>> decodeDraco(const Bytes& bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return draco::Decoder().DecodeMeshFromBuffer(&buffer);
}

Mesh fromDraco(const draco::Mesh& decoded)
{
    Mesh mesh;
    const draco::PointAttribute* positions = decoded.GetNamedAttribute(draco::GeometryAttribute::POSITION);
    for (uint32_t v = 0; v < decoded.num_points(); ++v) {
        Eigen::Vector3f position;
        positions->GetMappedValue(draco::PointIndex(v), position.data());
        mesh.positions.push_back(position.cast<double>());
    }
    for (uint32_t f = 0; f < decoded.num_faces(); ++f) {
        const draco::Mesh::Face& face = decoded.face(draco::FaceIndex(f));
        mesh.faces.push_back({static_cast<int>(face[0].value()), static_cast<int>(face[1].value()),
                              static_cast<int>(face[2].value())});
    }
    return mesh;
}

} // namespace

MeshCodec dracoCodec()
{
    MeshCodec codec;
    codec.extension = "drc";
    codec.fewestBits = 4;
    codec.mostBits = 20;
    codec.encode = [](const Mesh& mesh, int bits) { return encodeDraco(*toDraco(mesh), bits); };
    codec.decode = [](const Bytes& bytes) -> Result<Mesh> {
        const auto decoded = decodeDraco(bytes);
        if (!decoded.ok()) return failure(decoded.status());
        return fromDraco(*decoded.value());
    };
    return codec;
}

Result<Times> timeDraco(const Mesh& mesh, int runs)
{
    const std::unique_ptr<draco::Mesh> input = toDraco(referenced(mesh));
    return timeRuns(
        runs, [&] { return encodeDraco(*input, kTimedBits); },
        [](const Bytes& bytes) -> Status {
            const auto decoded = decodeDraco(bytes);
            if (!decoded.ok()) return failure(decoded.status());
            return Done{};
        });
}

} // namespace gimg::adapter
