// Wavefront OBJ: the statements v (with colours) and f; of the others only the syntax of vn and vt is looked
// at.
#include "soup_parsers.h"
#include "text_scan.h"

#include <algorithm>
#include <climits>

namespace gimg {

namespace {

class ObjParser
{
public:
    explicit ObjParser(std::string_view text) : scan_(text)
    {
        soup_.firstNumber = 1;
        soup_.lastLineOpen = text.back() != '\n' && text.back() != '\r';
    }

    Result<PolygonSoup> parse()
    {
        do {
            const std::string_view key = scan_.lineToken();
            bool good = true;
            if (key == "v") good = vertex();
            if (key == "f") good = face();
            if (key == "vn") good = numbers(3);
            if (key == "vt") good = numbers(1);
            if (!good) return failure(key);
        } while (scan_.nextLine());
        if (!soup_.columns.empty() && soup_.columns[0].values.size() != soup_.positions.size())
            soup_.columns.clear();
        return std::move(soup_);
    }

private:
    bool vertex()
    {
        Vec3 p;
        for (double& x : p) {
            const std::optional<double> value = number(scan_.lineToken());
            if (!value) return false;
            x = *value;
        }
        soup_.positions.push_back(p);
        color();
        return true;
    }

    // What some programs write after the position. It counts if every vertex has it.
    void color()
    {
        float rgb[3];
        for (float& x : rgb) {
            const std::optional<double> value = number(scan_.lineToken());
            if (!value) return;
            x = static_cast<float>(*value);
        }
        if (soup_.columns.empty())
            for (const char* name : {"red", "green", "blue"}) soup_.columns.push_back({name, GIM_F32, {}});
        for (int k = 0; k < 3; ++k) soup_.columns[k].values.push_back(rgb[k]);
    }

    bool face()
    {
        const size_t start = soup_.corners.size();
        for (std::string_view t = scan_.lineToken(); !t.empty(); t = scan_.lineToken())
            if (!corner(t)) return false;
        if (soup_.corners.size() < start + 3) return false;
        soup_.endFace();
        return true;
    }

    // v, v/vt, v//vn or v/vt/vn; a negative v counts back from the vertices so far.
    bool corner(std::string_view t)
    {
        const size_t slash = std::min(t.find('/'), t.size());
        if (t.find_first_not_of("0123456789-/", slash) != t.npos) return false;
        const std::optional<int64_t> index = integer(t.substr(0, slash));
        if (!index) return false;
        const int64_t v = *index > 0 ? *index - 1 : *index + static_cast<int64_t>(soup_.positions.size());
        if (*index == 0 || v < 0 || v > INT_MAX) {
            problem_ = "names a vertex " + std::to_string(*index) + " that cannot exist";
            return false;
        }
        soup_.corners.push_back(static_cast<int>(v));
        return true;
    }

    bool numbers(int count)
    {
        for (int i = 0; i < count; ++i)
            if (!number(scan_.lineToken())) return false;
        return true;
    }

    Error failure(std::string_view key) const
    {
        const std::string line = "line " + std::to_string(scan_.line());
        if (problem_.empty() && scan_.onLastLine())
            return {ErrorKind::FileTruncated,
                    "the file ends within the '" + std::string(key) + "' of " + line};
        const std::string count = key == "v"   ? "vertex " + std::to_string(soup_.positions.size() + 1) + " "
                                  : key == "f" ? "face " + std::to_string(soup_.faceCount() + 1) + " "
                                               : "";
        const std::string problem = !problem_.empty() ? problem_
                                    : key == "f"      ? "is not three or more vertex indices"
                                                      : "is not made of numbers";
        return {ErrorKind::FileCorrupt, line + ": " + count + problem};
    }

    TextScanner scan_;
    PolygonSoup soup_;
    std::string problem_; // with the statement at hand, where its syntax is right
};

} // namespace

Result<PolygonSoup> parseObj(std::string_view text) { return ObjParser(text).parse(); }

} // namespace gimg
