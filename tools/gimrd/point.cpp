#include "point.h"

#include "../cli.h"

#include <cmath>

namespace gimg::gimrd {
namespace {

using Json = nlohmann::ordered_json;

constexpr Point::State kStates[] = {Point::State::Done, Point::State::Unreachable, Point::State::Failed};

void addDistance(Json& json, const Point& p)
{
    const SurfaceDistance& d = p.distance;
    json["psnr"] = d.psnr(); // null where infinite: JSON has no such number
    json["rms_ref_to_test"] = d.rmsRefToTest;
    json["rms_test_to_ref"] = d.rmsTestToRef;
    json["max_ref_to_test"] = d.maxRefToTest;
    json["max_test_to_ref"] = d.maxTestToRef;
    json["hausdorff"] = d.hausdorff();
    json["normal_error_degrees"] = p.normalError ? Json(*p.normalError) : Json();
}

SurfaceDistance distanceFrom(const Json& json, double diagonal)
{
    SurfaceDistance d;
    d.diagonal = diagonal;
    d.rmsRefToTest = json.at("rms_ref_to_test");
    d.rmsTestToRef = json.at("rms_test_to_ref");
    d.maxRefToTest = json.at("max_ref_to_test");
    d.maxTestToRef = json.at("max_test_to_ref");
    return d;
}

Point readAll(const Json& json)
{
    Point p;
    p.mesh = json.at("mesh");
    p.sha256 = json.at("sha256");
    p.referenceFaces = json.at("reference_faces");
    p.diagonal = json.at("diagonal");
    p.note = json.at("note");
    p.coder = json.at("coder");
    p.grid = json.at("grid");
    p.samples = json.at("samples");
    p.target = json.at("target");
    const std::string state = json.at("state");
    for (const Point::State s : kStates)
        if (state == name(s)) p.state = s;
    p.message = json.at("message");
    p.versions = json.at("versions");
    if (p.state != Point::State::Done) return p;
    p.bytes = json.at("bytes");
    p.faces = json.at("faces");
    p.distance = distanceFrom(json, p.diagonal);
    if (const Json& angle = json.at("normal_error_degrees"); !angle.is_null()) p.normalError = angle;
    p.file = json.at("file");
    p.settings = json.at("settings");
    return p;
}

} // namespace

const char* name(Point::State state)
{
    switch (state) {
    case Point::State::Done:
        return "done";
    case Point::State::Unreachable:
        return "unreachable";
    case Point::State::Failed:
        break;
    }
    return "failed";
}

std::string jsonText(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string pointStem(const std::string& series, size_t target)
{
    return series + '-' + std::to_string(target);
}

Json toJson(const Point& p)
{
    Json json = {{"mesh", p.mesh},         {"sha256", p.sha256},   {"reference_faces", p.referenceFaces},
                 {"diagonal", p.diagonal}, {"note", p.note},       {"coder", p.coder},
                 {"grid", p.grid},         {"samples", p.samples}, {"target", p.target},
                 {"state", name(p.state)}, {"message", p.message}};
    if (p.state == Point::State::Done) {
        json["bytes"] = p.bytes;
        addDistance(json, p);
        json["faces"] = p.faces;
        json["file"] = p.file;
        json["settings"] = p.settings;
    }
    json["versions"] = p.versions;
    return json;
}

std::optional<Point> pointFromJson(const Json& json)
{
    try {
        return readAll(json);
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

std::optional<Point> readPoint(const std::filesystem::path& path)
{
    const std::optional<std::vector<uint8_t>> bytes = cli::readFile(path.string());
    if (!bytes) return std::nullopt;
    const Json json = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
    return json.is_discarded() ? std::nullopt : pointFromJson(json);
}

} // namespace gimg::gimrd
