/* A C99 program that knows gim.h and nothing else: prints the finest and the coarsest mesh of a file. */
#include <gim.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static unsigned char* readAll(const char* path, size_t* size)
{
    FILE* file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char* bytes = malloc(*size);
    if (bytes && fread(bytes, 1, *size, file) != *size) {
        free(bytes);
        bytes = NULL;
    }
    fclose(file);
    return bytes;
}

static int refuse(gim_status status)
{
    fprintf(stderr, "%s\n", gim_status_text(status));
    return 1;
}

int main(int argc, char** argv)
{
    size_t size = 0;
    unsigned char* bytes = argc == 2 ? readAll(argv[1], &size) : NULL;
    if (!bytes) return 2;

    gim_info info = {.size = sizeof info};
    gim_status status = gim_probe(bytes, size, NULL, &info);
    if (status != GIM_OK) return refuse(status);

    const size_t workSize = gim_workspace_size(&info);
    void* work = malloc(workSize);
    float* xyz = malloc(sizeof(float) * 3 * info.grid * info.grid);
    status = gim_decode_geometry(bytes, size, NULL, 0, work, workSize, xyz);
    if (status != GIM_OK) return refuse(status);

    for (uint32_t level = 0; level < info.levels; level += info.levels > 1 ? info.levels - 1 : 1) {
        gim_mesh_counts counts = {.size = sizeof counts};
        status = gim_mesh_size(bytes, size, NULL, 0, level, work, workSize, &counts);
        if (status != GIM_OK) return refuse(status);
        uint32_t* triangles = malloc(sizeof(uint32_t) * 3 * counts.triangles);
        uint32_t* sample = malloc(sizeof(uint32_t) * counts.vertices);
        status = gim_build_mesh(bytes, size, NULL, 0, level, work, workSize, xyz, NULL, sample, triangles);
        if (status != GIM_OK) return refuse(status);

        double area = 0;
        for (uint32_t t = 0; t < counts.triangles; ++t) {
            const float* p = xyz + 3 * sample[triangles[3 * t]];
            const float* q = xyz + 3 * sample[triangles[3 * t + 1]];
            const float* r = xyz + 3 * sample[triangles[3 * t + 2]];
            double u[3], v[3];
            for (int k = 0; k < 3; ++k) {
                u[k] = (double)q[k] - p[k];
                v[k] = (double)r[k] - p[k];
            }
            const double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
            area += 0.5 * sqrt(x * x + y * y + z * z);
        }
        printf("level %u: %u vertices, %u triangles, area %.2f\n", level, counts.vertices, counts.triangles, area);
        free(triangles);
        free(sample);
    }
    free(xyz);
    free(work);
    free(bytes);
    return 0;
}
