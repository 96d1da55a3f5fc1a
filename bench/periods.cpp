// gimg_periods [MESH... | --known | --scale]: period matrices, their errors and how long they take, as
// tables.
#include "gimg/periods.h"
#include "gimg/harmonic.h"
#include "gimg/holomorphic.h"
#include "gimg/mesh_io.h"

#include "conformal/known_surfaces.h"
#include "shapes.h"

#include <Eigen/Dense>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace {

using namespace gimg;
using Complex = std::complex<double>;

class Stopwatch
{
public:
    double seconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

ConformalOptions unsplit()
{
    ConformalOptions options;
    options.starResidual = std::numeric_limits<double>::infinity();
    return options;
}

double leastImaginary(const ConformalStructure& structure)
{
    const Eigen::MatrixXd imaginary = structure.periodMatrix.imag();
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(imaginary, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

std::string name(std::string path)
{
    path = path.substr(path.find_last_of('/') + 1);
    return path.substr(0, path.find_last_of('.'));
}

int tableOfMesh(const std::string& path)
{
    const Result<MeshFile> read = readMesh(path);
    if (!read) return std::fprintf(stderr, "%s: %s\n", path.c_str(), read.error().message.c_str()), 1;
    const PolyhedralSurface surface = polyhedralSurface(read->mesh);
    const Result<CanonicalBasis> loops = canonicalBasis(surface);
    if (!loops) return std::fprintf(stderr, "%s: %s\n", path.c_str(), loops.error().message.c_str()), 1;
    const Result<ConformalStructure> coarse = conformalStructure(surface, *loops, unsplit());
    const Result<ConformalStructure> finer = conformalStructure(known::splitInFour(surface), unsplit());
    const Stopwatch watch;
    const Result<ConformalStructure> split = conformalStructure(surface);
    const double seconds = watch.seconds();
    const Result<ConformalStructure> inLoops = conformalStructure(surface, *loops);
    if (!coarse || !finer || !split || !inLoops) return std::fprintf(stderr, "%s failed\n", path.c_str()), 1;
    std::printf("| %s | %d | %d | %.4f | %.1e | %.1e | %.1e | %.1e | %d | %.1e | %.1e | %.4f | %.2f |\n",
                name(path).c_str(), surface.faceCount(), coarse->genus, leastImaginary(*split),
                coarse->asymmetry, coarse->starResidual, finer->asymmetry, finer->starResidual,
                split->triangles, split->asymmetry, split->starResidual,
                periodDistance(coarse->periodMatrix, inLoops->periodMatrix), seconds);
    std::fflush(stdout);
    return 0;
}

void rowOfTorus(const char* what, const Mesh& torus)
{
    const Result<ConformalStructure> structure = conformalStructure(torus, unsplit());
    if (!structure) return;
    const Complex tau = *reducedModulus(structure->periodMatrix(0, 0)), known(0, 1 / std::sqrt(8.0));
    const ShapeFactors shape = *shapeFactors(tau);
    std::printf("| %s | %d | %.2e | %.4f | %.5f | %.1e |\n", what, torus.vertexCount(),
                std::abs(-1.0 / tau - known), shape.angleDegrees, shape.lengthRatio, structure->starResidual);
}

void rowOfKnown(const char* what, const PolyhedralSurface& surface, const Eigen::MatrixXcd& known,
                const ConformalOptions& options)
{
    const Result<ConformalStructure> structure = conformalStructure(surface, options);
    if (!structure) return;
    EquivalenceOptions within;
    within.tolerance = 0.5;
    const Result<Equivalence> found = conformallyEquivalent(structure->periodMatrix, known, within);
    if (!found) return;
    std::printf("| %s | %d | %d | %.1e | %.1e |\n", what, surface.faceCount(), structure->triangles,
                structure->starResidual, found->distance);
}

void tablesOfKnown()
{
    for (const int n : {16, 32, 64, 128}) rowOfTorus("grid", shapes::torus(3, 1, n, 2 * n));
    for (const int n : {16, 32, 64, 128})
        rowOfTorus("vertices moved", known::roughTorus(3, 1, 2 * n, n, 0.3, false, 7));
    for (const int n : {16, 32, 64, 128})
        rowOfTorus("irregular", known::roughTorus(3, 1, 2 * n, n, 0.3, true, 7));
    rowOfTorus("grid", shapes::torus(3, 1, 33, 33));
    rowOfTorus("irregular", known::roughTorus(3, 1, 33, 33, 0.3, true, 2));

    const Complex i(0, 1);
    Eigen::MatrixXcd lawson(2, 2), squares(2, 2), bolza(2, 2);
    lawson << 2, -1, -1, 2;
    lawson *= i / std::sqrt(3.0);
    squares << 5, 1, 1, 2;
    squares *= i / 3.0;
    const Complex p(-2, std::sqrt(8)), q(1, -std::sqrt(2));
    bolza << p, q, q, p;
    bolza /= 3;
    for (const double residual : {std::numeric_limits<double>::infinity(), 0.01, 0.001}) {
        ConformalOptions options;
        options.starResidual = residual;
        std::printf("\nresidual asked for: %g\n", residual);
        for (const int n : {3, 6, 12, 24})
            rowOfKnown("three squares", known::squareTiled({1, 0, 2}, {2, 1, 0}, n, 0.2, 1.4), squares,
                       options);
        for (const int n : {3, 6, 12, 24})
            rowOfKnown("Lawson", known::coverOverEquator(6, n, 0.2, 1.8), lawson, options);
        for (const int n : {3, 6, 12, 24})
            rowOfKnown("x^5 - x", known::coverOverOctahedron(n, 0.2, 1.8), bolza, options);
    }
    std::printf("\nsymmetric\n");
    rowOfKnown("three squares", known::squareTiled({1, 0, 2}, {2, 1, 0}, 6), squares, unsplit());
    rowOfKnown("Lawson", known::coverOverEquator(6, 6), lawson, unsplit());
    rowOfKnown("x^5 - x", known::coverOverOctahedron(6), bolza, unsplit());
}

void tableOfScale()
{
    for (const int n : {14, 27, 54, 108}) {
        const Mesh mesh = shapes::surfaceOfGenus(3, 0, n);
        const Stopwatch watch;
        const Result<CanonicalBasis> loops = canonicalBasis(mesh);
        const double loopSeconds = watch.seconds();
        if (!loops || !conformalStructure(polyhedralSurface(mesh), *loops)) return;
        std::printf("| %d | %.2f | %.2f |\n", mesh.faceCount(), loopSeconds, watch.seconds());
        std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2) return std::fprintf(stderr, "gimg_periods [MESH... | --known | --scale]\n"), 2;
    if (argv[1] == std::string("--known")) return tablesOfKnown(), 0;
    if (argv[1] == std::string("--scale")) return tableOfScale(), 0;
    int failures = 0;
    for (int i = 1; i < argc; ++i) failures += tableOfMesh(argv[i]);
    return failures > 0;
}
