#include "curves.h"
#include "number_text.h"

#include "../cli.h"
#include "../process.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace gimg::gimrd {
namespace {

namespace fs = std::filesystem;

// Colours that stay apart for colour-blind readers (Okabe and Ito), warm for ours, cool for peers.
constexpr const char* kOurColors[] = {"#d55e00", "#cc79a7", "#e69f00"};
constexpr const char* kPeerColors[] = {"#0072b2", "#009e73", "#56b4e9", "#7d5ba6", "#8c6d31", "#7f7f7f"};
constexpr int kPeerPoints[] = {5, 9, 11, 13, 4, 8, 10, 12};

struct Curve
{
    std::string label;
    LineStyle style;
    std::vector<RatePoint> points;
};

std::string quoted(const std::string& text)
{
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
    return out + '\'';
}

// To whole steps of 5 dB around the points; gnuplot alone refuses a range that is empty.
std::string psnrRange(const std::vector<Curve>& curves)
{
    double low = curves[0].points[0].psnr, high = low;
    for (const Curve& curve : curves)
        for (const RatePoint& p : curve.points) low = std::min(low, p.psnr), high = std::max(high, p.psnr);
    return "set yrange [" + fixedText(5 * std::floor((low - 0.5) / 5), 0) + ':' +
           fixedText(5 * std::ceil((high + 0.5) / 5), 0) + "]\n";
}

// What all plots share; gnuplot's own defaults are set again so that no file of the user's changes them.
std::string frame(const std::string& title, const std::vector<size_t>& sizes)
{
    std::ostringstream script;
    script << "set encoding utf8\n"
           << "set title " << quoted(title) << " noenhanced\n"
           << "set logscale x 2\nset xlabel 'bytes'\nset ylabel 'PSNR, dB'\n"
           << "set border 3\nset tics nomirror\nset grid xtics ytics lt 1 lc rgb '#b0b0b0' lw 0.5\n"
           << "set key below center horizontal noenhanced spacing 1.2\nset xtics (";
    for (size_t s = 0; s < sizes.size(); ++s)
        script << (s > 0 ? ", " : "") << quoted(grouped(sizes[s])) << ' ' << sizes[s];
    script << ")\nset xrange [" << fixedText(static_cast<double>(sizes.front()) * 0.8, 3) << ':'
           << fixedText(static_cast<double>(sizes.back()) * 1.25, 3) << "]\n";
    return script.str();
}

std::string plot(const std::vector<Curve>& curves)
{
    std::ostringstream script;
    for (size_t c = 0; c < curves.size(); ++c) {
        script << "$c" << c << " << EOD\n";
        for (const RatePoint& p : curves[c].points)
            script << shortest(p.bytes) << ' ' << shortest(p.psnr) << '\n';
        script << "EOD\n";
    }
    script << "plot ";
    for (size_t c = 0; c < curves.size(); ++c) // the first is drawn last, above the others
        script << (c > 0 ? ", " : "") << "$c" << c << " using 1:2 with linespoints title "
               << quoted(curves[c].label) << " lc rgb '" << curves[c].style.color << "' lw "
               << fixedText(curves[c].style.width, 1) << " pt " << curves[c].style.point << " ps 0.7";
    script << '\n';
    return script.str();
}

// Draws the same plot as SVG and as PNG beside it.
Status draw(const std::string& title, const std::vector<size_t>& sizes, const std::vector<Curve>& curves,
            const fs::path& svg, SweepFolder& folder)
{
    const fs::path script = folder.temporary(".gnuplot");
    const fs::path drafts[] = {folder.temporary(".svg"), folder.temporary(".png")};
    const std::string body = frame(title, sizes) + psnrRange(curves) + plot(curves);
    const std::string text =
        "set terminal svg size 760,520 dynamic noenhanced font 'sans-serif,14' background '#ffffff'\n"
        "set output " +
        quoted(drafts[0].string()) + '\n' + body +
        "set terminal pngcairo size 1140,780 noenhanced font 'sans-serif,15' linewidth 1.4 pointscale 1.4\n"
        "set output " +
        quoted(drafts[1].string()) + "\nreplot\nset output\n";
    const Status written = folder.publishText(text, script);
    if (!written) return written;
    const Result<cli::Ended> ended =
        cli::runProgram({"gnuplot", "-d", script.string()}, [](const std::string&) {});
    if (!ended) return ended.error();
    if (ended->code != 0)
        return Error{ErrorKind::CodecFailure,
                     "gnuplot cannot draw " + svg.filename().string() + ": " + cli::lastLine(ended->errors)};
    const Status published = folder.publish(drafts[0], svg);
    if (!published) return published;
    return folder.publish(drafts[1], fs::path(svg).replace_extension(".png"));
}

std::vector<Curve> curvesOf(const SweepResults& results, const SweepResults::Row& row)
{
    const std::vector<LineStyle> styles = lineStyles(results);
    std::vector<Curve> curves;
    for (size_t c = 0; c < results.series.size(); ++c) {
        std::vector<RatePoint> points = ratePoints(row, c);
        std::erase_if(points, [](const RatePoint& p) { return !std::isfinite(p.psnr); });
        if (!points.empty()) curves.push_back({results.series[c].label, styles[c], std::move(points)});
    }
    return curves;
}

std::vector<Curve> curvesOfMeans(const SweepResults& results)
{
    const std::vector<LineStyle> styles = lineStyles(results);
    const MeanCurves means = meanCurves(results);
    std::vector<Curve> curves;
    for (size_t c = 0; c < results.series.size(); ++c) {
        Curve curve{results.series[c].label, styles[c], {}};
        for (size_t s = 0; s < results.sizes.size(); ++s)
            if (std::isfinite(means.psnr[c][s]))
                curve.points.push_back({static_cast<double>(results.sizes[s]), means.psnr[c][s]});
        if (!curve.points.empty()) curves.push_back(std::move(curve));
    }
    return curves;
}

} // namespace

std::vector<LineStyle> lineStyles(const SweepResults& results)
{
    std::vector<LineStyle> styles;
    size_t ours = 0, peers = 0;
    for (const SweepResults::Column& series : results.series)
        if (series.ours) {
            styles.push_back({kOurColors[ours % std::size(kOurColors)], 3, ours == 0 ? 7 : 6});
            ++ours;
        } else {
            styles.push_back({kPeerColors[peers % std::size(kPeerColors)], 1.5,
                              kPeerPoints[peers % std::size(kPeerPoints)]});
            ++peers;
        }
    return styles;
}

Status drawCurves(const SweepResults& results, SweepFolder& folder)
{
    for (const SweepResults::Row& row : results.meshes) {
        const std::vector<Curve> curves = curvesOf(results, row);
        if (curves.empty()) continue;
        const Status drawn =
            draw(row.name, results.sizes, curves, folder.path() / "curves" / (row.name + ".svg"), folder);
        if (!drawn) return drawn;
    }
    const std::vector<Curve> means = curvesOfMeans(results);
    if (results.meshes.size() < 2 || means.empty()) return Done{};
    return draw("Mean over the meshes", results.sizes, means, folder.path() / "mean.svg", folder);
}

std::string missingForCurves()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((folder + "/gnuplot").c_str(), X_OK) == 0) return "";
    return "gnuplot-nox";
}

} // namespace gimg::gimrd
