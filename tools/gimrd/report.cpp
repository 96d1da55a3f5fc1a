#include "report.h"

#include "curves.h"
#include "number_text.h"

#include "../cli.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <regex>
#include <set>

namespace gimg::gimrd {
namespace {

namespace fs = std::filesystem;
using State = Point::State;

constexpr const char* kNone = "–";
constexpr size_t kMeshesShownOpen = 6;

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #d5d5d0; --soft: #f5f4f0; --faint: #6b6b66; --alert: #fbeee0; }
@media (prefers-color-scheme: dark) { :root { --line: #44443f; --soft: #262624; --faint: #a3a39c;
  --alert: #43301a; } body { background: #1a1a19; color: #e6e5df; } }
* { box-sizing: border-box; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 64rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .5rem; }
h2 { font-size: 1.3rem; margin: 2.5rem 0 .5rem; padding-top: .6rem; border-top: 2px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.5rem 0 .3rem; }
p { max-width: 46rem; } .note, figcaption, caption { color: var(--faint); font-size: .88rem; }
caption { text-align: left; padding-bottom: .3rem; }
.scroll { overflow-x: auto; margin: .6rem 0 1.2rem; }
table { border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { padding: .22rem .6rem; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 1px solid var(--line); font-weight: 600; }
tbody th { font-weight: 400; } tr.mesh th { font-weight: 600; background: var(--soft); }
tr.mesh th span { font-weight: 400; color: var(--faint); }
td.failed { color: #c0392b; } i.key { display: inline-block; width: .9em; height: .9em; border-radius: 50%;
  margin-right: .45em; vertical-align: -.08em; print-color-adjust: exact; }
.alert { background: var(--alert); padding: .6rem 1rem; border-radius: 6px; margin: 1rem 0; }
.alert ul { margin: .3rem 0; padding-left: 1.2rem; } code { font-size: .9em; overflow-wrap: anywhere; }
figure { margin: .5rem 0 1rem; } figure svg { width: 100%; max-width: 760px; height: auto; display: block; }
.pictures td, .pictures th { padding: .2rem; text-align: center; vertical-align: top; }
.pictures th:first-child { text-align: left; vertical-align: middle; max-width: 9rem; white-space: normal; }
.pictures img { width: 8.2rem; height: 8.2rem; display: block; border-radius: 4px; }
.pictures span { font-size: .82rem; } summary { cursor: pointer; font-weight: 600; }
nav a { margin-right: .8rem; }
@media print { body { max-width: none; font-size: 11px; } nav { display: none; } .scroll { overflow: visible; }
  figure, tr, .alert { break-inside: avoid; } .pictures img { width: 5.4rem; height: 5.4rem; }
  h2, h3 { break-after: avoid; } }
)";

constexpr const char* kDefinitions =
    R"(<p class="note">Bjontegaard deltas: the mean distance of two curves over the range that both cover, PSNR over
log<sub>10</sub> bytes (BD-PSNR) or log<sub>10</sub> bytes over PSNR (BD-rate), with piecewise cubic Hermite
interpolation. n/a: a coder has fewer than four points that each improve on every smaller file, or the ranges do not
meet. Image coders code the geometry image that gimg makes of the mesh, or that was given; their result is measured as a
grid with open borders. In the pictures red is the inside of the surface, seen through cracks and folds.</p>
)";
static_assert(kBjontegaardPoints == 4, "said above");

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    return out;
}

std::string dBText(double psnr) { return std::isinf(psnr) ? "∞" : fixedText(psnr, 2); }

std::string signedText(double value, int decimals)
{
    std::string text = fixedText(std::abs(value), decimals);
    if (text.find_first_not_of("0.") == std::string::npos) return text;
    return (value < 0 ? "−" : "+") + text;
}

std::string count(size_t number, const std::string& one)
{
    return grouped(number) + ' ' + one + (number == 1 ? "" : one.back() == 'h' ? "es" : "s");
}

std::string base64(const std::vector<uint8_t>& bytes)
{
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = std::min<size_t>(3, bytes.size() - i);
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0U);
        for (size_t k = 0; k < 4; ++k) out += k <= left ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return out;
}

// gnuplot's file as a part of the page: names of its own, so that several can stand in one page, and the
// page's text colour instead of black on white.
std::string inlineSvg(const fs::path& path, const std::string& title, const std::string& prefix)
{
    const std::optional<std::vector<uint8_t>> bytes = cli::readFile(path.string());
    if (!bytes) return "";
    std::string svg(bytes->begin(), bytes->end());
    svg.erase(0, svg.find("<svg"));
    const std::pair<const char*, std::string> edits[] = {
        {R"(<title>[^<]*</title>)", "<title>" + escaped(title) + "</title>"},
        {R"(<desc>[^<]*</desc>\s*)", ""},
        {R"(<rect x="0" y="0" [^>]*fill="#ffffff"/>)", ""},
        {R"(\bid=(['"]))", "id=$1" + prefix},
        {R"(href='#)", "href='#" + prefix},
        {R"(url\(#)", "url(#" + prefix},
        {R"( color="black")", ""},
        {R"((fill|stroke)=(['"])black['"])", "$1=$2currentColor$2"}};
    for (const auto& [pattern, replacement] : edits)
        svg = std::regex_replace(svg, std::regex(pattern), replacement);
    return svg;
}

std::string figure(const fs::path& svg, const std::string& title, const std::string& prefix,
                   const std::string& caption)
{
    const std::string drawing = inlineSvg(svg, title, prefix);
    if (drawing.empty()) return "";
    return "<figure>" + drawing + "<figcaption>" + caption + "</figcaption></figure>\n";
}

class Report
{
public:
    Report(const SweepResults& results, const SweepFolder& folder)
        : results_(results), folder_(folder), styles_(lineStyles(results))
    {
    }

    std::string html() const
    {
        return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
               "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
               "<title>Rate against distortion</title>\n<style>" +
               std::string(kStyle) + "</style>\n</head>\n<body>\n" + introduction() + problems() +
               overview() + allMeshes() + howMade() + "</body>\n</html>\n";
    }

private:
    std::string key(size_t series) const
    {
        return "<i class=\"key\" style=\"background:" + styles_[series].color + "\"></i>" +
               escaped(results_.series[series].label);
    }

    std::string introduction() const
    {
        std::string html = "<h1>Rate against distortion</h1>\n<p>" + count(results_.meshes.size(), "mesh") +
                           ", " + count(results_.series.size(), "coder") + ", files of at most ";
        for (size_t s = 0; s < results_.sizes.size(); ++s)
            html += (s == 0                           ? ""
                     : s + 1 == results_.sizes.size() ? " and "
                                                      : ", ") +
                    grouped(results_.sizes[s]);
        html +=
            " bytes. Each decoded mesh was compared with the original by its surface: PSNR is "
            "20&nbsp;log<sub>10</sub>(D/d), D the diagonal of the bounding box and d the larger of the two "
            "one-sided root mean square distances over " +
            grouped(static_cast<size_t>(results_.samples)) + " samples each way.</p>\n<nav>";
        for (size_t m = 0; m < results_.meshes.size(); ++m)
            html +=
                "<a href=\"#mesh-" + std::to_string(m) + "\">" + escaped(results_.meshes[m].name) + "</a> ";
        return html + "</nav>\n";
    }

    // What a reader must know before trusting a table.
    std::string problems() const
    {
        std::string items;
        for (const Absence& absence : results_.skipped) {
            items += "<li>" + escaped(absence.title) + " (<code>" + escaped(absence.coder) +
                     "</code>) was skipped: not installed. Debian packages:";
            for (const std::string& package : absence.packages)
                items += " <code>" + escaped(package) + "</code>";
            items += "</li>\n";
        }
        for (const std::string& broken : results_.broken) items += "<li>" + escaped(broken) + "</li>\n";
        for (const SweepResults::Row& row : results_.meshes) items += failures(row);
        for (const SweepResults::Row& row : results_.meshes)
            if (!row.note.empty())
                items += "<li>" + escaped(row.note) + "; taken as triangles without topology</li>\n";
        return items.empty() ? "" : "<div class=\"alert\"><ul>\n" + items + "</ul></div>\n";
    }

    // One line for all sizes that failed alike.
    std::string failures(const SweepResults::Row& row) const
    {
        std::string items;
        for (size_t c = 0; c < results_.series.size(); ++c) {
            std::vector<std::pair<std::string, std::string>> messages; // and the sizes
            for (size_t s = 0; s < results_.sizes.size(); ++s) {
                const std::optional<Point>& p = row.points[c][s];
                if (!p || p->state != State::Failed) continue;
                const auto same = std::find_if(messages.begin(), messages.end(),
                                               [&](const auto& m) { return m.first == p->message; });
                if (same != messages.end())
                    same->second += ", " + grouped(p->target);
                else
                    messages.emplace_back(p->message, grouped(p->target));
            }
            for (const auto& [message, sizes] : messages)
                items += "<li>" + escaped(row.name) + ", " + escaped(results_.series[c].label) + ", " +
                         sizes + " bytes: failed: " + escaped(message) + "</li>\n";
        }
        return items;
    }

    std::string overview() const
    {
        std::string html = "<h2>Overview</h2>\n";
        if (results_.meshes.size() > 1) {
            html += figure(folder_.path() / "mean.svg", "Mean over the meshes", "mean-", meansCaption());
        }
        html += psnrTable();
        if (results_.series.size() > 1 && results_.meshes.size() > 1) html += meanDeltas();
        return html;
    }

    std::string meansCaption() const
    {
        const std::vector<int> meshes = meanCurves(results_).meshes;
        const auto all = static_cast<int>(results_.meshes.size());
        if (std::ranges::all_of(meshes, [&](int n) { return n == all; })) return "Mean PSNR over the meshes.";
        std::string caption = "Mean PSNR over the meshes for which every coder has a file:";
        for (size_t s = 0; s < results_.sizes.size(); ++s)
            caption += (s == 0 ? " " : ", ") + std::to_string(meshes[s]) + " of " + std::to_string(all) +
                       " at " + grouped(results_.sizes[s]);
        return caption + " bytes.";
    }

    std::string sizeHeads() const
    {
        std::string html;
        for (const size_t size : results_.sizes) html += "<th scope=\"col\">" + grouped(size) + "</th>";
        return html;
    }

    std::string psnrTable() const
    {
        std::string html =
            "<div class=\"scroll\"><table>\n<caption>PSNR in dB of the best file of at most so many "
            "bytes; the best coder of each size in bold. " +
            std::string(kNone) +
            ": no such file, see the note of the cell.</caption>\n"
            "<thead><tr><th scope=\"col\">bytes</th>" +
            sizeHeads() + "</tr></thead>\n<tbody>\n";
        for (const SweepResults::Row& row : results_.meshes) {
            html += "<tr class=\"mesh\"><th scope=\"rowgroup\" colspan=\"" +
                    std::to_string(results_.sizes.size() + 1) + "\">" + escaped(row.name) + " <span>" +
                    (row.faces > 0 ? count(static_cast<size_t>(row.faces), "triangle") : "not readable") +
                    "</span></th></tr>\n";
            for (size_t c = 0; c < results_.series.size(); ++c) {
                if (!hasPoint(row, c)) continue;
                html += "<tr><th scope=\"row\">" + key(c) + "</th>";
                for (size_t s = 0; s < results_.sizes.size(); ++s) html += psnrCell(row, c, s);
                html += "</tr>\n";
            }
        }
        return html + "</tbody></table></div>\n";
    }

    static bool hasPoint(const SweepResults::Row& row, size_t series)
    {
        return std::any_of(row.points[series].begin(), row.points[series].end(),
                           [](const std::optional<Point>& p) { return p.has_value(); });
    }

    std::string psnrCell(const SweepResults::Row& row, size_t series, size_t size) const
    {
        const std::optional<Point>& p = row.points[series][size];
        if (!p) return "<td>" + std::string(kNone) + "</td>";
        if (p->state == State::Failed)
            return "<td class=\"failed\" title=\"" + escaped(p->message) + "\">failed</td>";
        if (p->state == State::Unreachable)
            return "<td title=\"" + escaped(p->message) + "\">" + kNone + "</td>";
        const std::string text = dBText(p->distance.psnr());
        const bool best = text == bestText(row, size);
        return "<td title=\"" + grouped(p->bytes) + " bytes, " +
               count(static_cast<size_t>(p->faces), "triangle") + "\">" +
               (best ? "<b>" + text + "</b>" : text) + "</td>";
    }

    // As shown, so that what looks alike is marked alike.
    static std::string bestText(const SweepResults::Row& row, size_t size)
    {
        double best = -1e300;
        for (const auto& series : row.points)
            if (series[size] && series[size]->state == State::Done)
                best = std::max(best, series[size]->distance.psnr());
        return dBText(best);
    }

    // A table of every series against every other; cell(reference, test) is its text.
    template <class Cell>
    std::string matrix(const std::string& caption, const std::vector<size_t>& shown, const Cell& cell) const
    {
        std::string html = "<div class=\"scroll\"><table>\n<caption>" + caption +
                           "</caption>\n<thead><tr><th scope=\"col\">coder \\ against</th>";
        for (const size_t c : shown) html += "<th scope=\"col\">" + key(c) + "</th>";
        html += "</tr></thead>\n<tbody>\n";
        for (const size_t test : shown) {
            html += "<tr><th scope=\"row\">" + key(test) + "</th>";
            for (const size_t reference : shown)
                html += "<td>" + (test == reference ? std::string() : cell(reference, test)) + "</td>";
            html += "</tr>\n";
        }
        return html + "</tbody></table></div>\n";
    }

    static std::string deltaText(const std::optional<double>& value, int decimals, const std::string& unit)
    {
        return value ? signedText(*value, decimals) + unit : "n/a";
    }

    std::string meanDeltas() const
    {
        std::vector<size_t> shown(results_.series.size());
        for (size_t c = 0; c < shown.size(); ++c) shown[c] = c;
        const auto of = [&](int meshes) {
            return " <span class=\"note\">(" + std::to_string(meshes) + ")</span>";
        };
        return "<h3>Bjontegaard deltas, mean over the meshes</h3>\n" +
               matrix("BD-rate: bytes more (+) or fewer (−) than the coder of the column needs at equal "
                      "PSNR. In "
                      "brackets: the number of meshes with such a value.",
                      shown,
                      [&](size_t reference, size_t test) {
                          const MeanBjontegaard d = meanBjontegaard(results_, reference, test);
                          return deltaText(d.mean.ratePercent, 1, "&nbsp;%") + of(d.rateMeshes);
                      }) +
               matrix("BD-PSNR: dB more (+) or less (−) than the coder of the column at equal bytes.", shown,
                      [&](size_t reference, size_t test) {
                          const MeanBjontegaard d = meanBjontegaard(results_, reference, test);
                          return deltaText(d.mean.psnr, 2, "&nbsp;dB") + of(d.psnrMeshes);
                      });
    }

    std::string allMeshes() const
    {
        std::string html;
        for (size_t m = 0; m < results_.meshes.size(); ++m) html += mesh(m);
        return html;
    }

    std::string mesh(size_t index) const
    {
        const SweepResults::Row& row = results_.meshes[index];
        const std::string number = std::to_string(index);
        std::string html = "<h2 id=\"mesh-" + number + "\">" + escaped(row.name) + "</h2>\n";
        html += figure(folder_.path() / "curves" / (row.name + ".svg"), row.name, "m" + number + "-",
                       "PSNR over the bytes of the files, bytes on a logarithmic scale.");
        std::vector<size_t> shown;
        for (size_t c = 0; c < results_.series.size(); ++c)
            if (hasPoint(row, c)) shown.push_back(c);
        if (shown.size() > 1) html += deltas(row, shown);
        return html + pictures(row, shown);
    }

    std::string deltas(const SweepResults::Row& row, const std::vector<size_t>& shown) const
    {
        const auto delta = [&](size_t reference, size_t test) {
            return bjontegaard(ratePoints(row, reference), ratePoints(row, test));
        };
        return "<h3>Bjontegaard deltas</h3>\n" +
               matrix("BD-rate", shown,
                      [&](size_t reference, size_t test) {
                          return deltaText(delta(reference, test).ratePercent, 1, "&nbsp;%");
                      }) +
               matrix("BD-PSNR", shown, [&](size_t reference, size_t test) {
                   return deltaText(delta(reference, test).psnr, 2, "&nbsp;dB");
               });
    }

    std::string picture(const SweepResults::Row& row, const std::string& stem, const std::string& alt) const
    {
        const std::optional<std::vector<uint8_t>> png =
            cli::readFile(folder_.thumbnail(row.name, stem).string());
        if (!png) return "";
        return "<img alt=\"" + escaped(alt) + "\" src=\"data:image/png;base64," + base64(*png) + "\">";
    }

    std::string pictures(const SweepResults::Row& row, const std::vector<size_t>& shown) const
    {
        if (row.faces == 0) return "";
        std::string html = "<details";
        if (results_.meshes.size() <= kMeshesShownOpen) html += " open";
        html += "><summary>Reconstructions, with PSNR and the root mean square error of the "
                "normals</summary>\n<div class=\"scroll\"><table "
                "class=\"pictures\">\n<thead><tr>"
                "<th scope=\"col\">bytes</th>" +
                sizeHeads() +
                "<th scope=\"col\">original</th></tr></thead>\n"
                "<tbody>\n";
        for (const size_t c : shown) {
            html += "<tr><th scope=\"row\">" + key(c) + "</th>";
            for (size_t s = 0; s < results_.sizes.size(); ++s) html += pictureCell(row, c, s);
            html += "<td>" + picture(row, "original", row.name) + "</td></tr>\n";
        }
        return html + "</tbody></table></div></details>\n";
    }

    std::string pictureCell(const SweepResults::Row& row, size_t series, size_t size) const
    {
        const std::optional<Point>& p = row.points[series][size];
        if (!p || p->state != State::Done)
            return "<td><span>" + std::string(p && p->state == State::Failed ? "failed" : kNone) +
                   "</span></td>";
        const std::string stem = pointStem(results_.series[series].id, p->target);
        const std::string dB = dBText(p->distance.psnr()) + " dB";
        const std::string angle = p->normalError ? ", " + fixedText(*p->normalError, 1) + "°" : "";
        return "<td>" + picture(row, stem, row.name + ", " + results_.series[series].label + ", " + dB) +
               "<span>" + dB + angle + "</span></td>";
    }

    std::string howMade() const
    {
        std::string html =
            "<h2>How this was made</h2>\n<p><code>" + escaped(results_.command) +
            "</code></p>\n<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">coder</th>"
            "<th scope=\"col\">made with</th></tr></thead><tbody>\n";
        for (size_t c = 0; c < results_.series.size(); ++c) {
            std::string list;
            for (const auto& [package, versions] : results_.series[c].versions.items())
                for (const auto& version : versions)
                    list += (list.empty() ? "" : ", ") +
                            escaped(package + ' ' + version.template get<std::string>());
            html += "<tr><th scope=\"row\">" + key(c) + " <code>" + escaped(results_.series[c].id) +
                    "</code></th><td>" + list + "</td></tr>\n";
        }
        html +=
            "</tbody></table></div>\n<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">mesh</th>"
            "<th scope=\"col\">triangles</th><th scope=\"col\">SHA-256</th></tr></thead><tbody>\n";
        for (const SweepResults::Row& row : results_.meshes)
            html += "<tr><th scope=\"row\">" + escaped(row.name) + "</th><td>" +
                    grouped(static_cast<size_t>(row.faces)) + "</td><td><code>" + row.sha256 +
                    "</code></td></tr>\n";
        return html + "</tbody></table></div>\n" + kDefinitions;
    }

    const SweepResults& results_;
    const SweepFolder& folder_;
    std::vector<LineStyle> styles_;
};

} // namespace

std::string reportHtml(const SweepResults& results, const SweepFolder& folder)
{
    return Report(results, folder).html();
}

} // namespace gimg::gimrd
