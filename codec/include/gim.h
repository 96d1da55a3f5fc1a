/* gim.h - reads .gim geometry image files.
 *
 * A .gim file holds a surface as a square grid of samples. The square's border is a seam: its
 * sides are glued in pairs (or are the surface's own boundary), and the glued samples are one
 * point of the surface. This library turns the bytes into samples, and the samples into a
 * triangle mesh without cracks, at any of the file's levels of detail.
 *
 * How a caller goes about it:
 *
 *     gim_info info = { sizeof info };
 *     gim_status status = gim_probe(bytes, size, NULL, &info);
 *     void* work = malloc(gim_workspace_size(&info));
 *     float* xyz = malloc(sizeof(float) * 3 * info.grid * info.grid);
 *     status = gim_decode_geometry(bytes, size, NULL, 0, work, gim_workspace_size(&info), xyz);
 *
 * Rules that hold for every function:
 * - Nothing is allocated. Scratch memory is the caller's `workspace`, of any alignment; its content
 *   means nothing between calls. Buffers must not overlap.
 * - No state is kept, so calls may run at the same time on different workspaces.
 * - Any bytes are safe to pass. A refused file leaves the output buffers with unspecified content.
 * - Decoded samples are the same to the last bit on every platform.
 * - A struct with a `size` member must have it set to sizeof the struct before the call, so that
 *   later versions can add members. A size that is too small gives GIM_MISUSE.
 * - A NULL pointer where one is needed gives GIM_MISUSE.
 *
 * Shapes. A grid of n samples a side (n = 2^j + 1) is stored row by row: sample (i, j) is number
 * j * n + i, at the square's point s = i / (n-1), t = j / (n-1). Border samples are also numbered
 * along the border, counter-clockwise from (0, 0): bottom, right, top, left, 4 (n-1) in all.
 */
#ifndef GIM_H
#define GIM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef GIM_API
#define GIM_API
#endif

/* The file format's version this header was written for. */
#define GIM_FORMAT_VERSION 1

typedef enum gim_status {
    GIM_OK = 0,
    GIM_MORE_INPUT = 1,  /* the bytes end before the file does */
    GIM_CORRUPT = 2,     /* the bytes contradict the format, or a checksum */
    GIM_UNSUPPORTED = 3, /* another version, or a critical chunk or coding unknown here */
    GIM_LIMIT = 4,       /* the file is larger than the caller's limits allow */
    GIM_MISUSE = 5       /* an argument is wrong; nothing is said about the file */
} gim_status;

/* A short English phrase, never NULL. */
GIM_API const char* gim_status_text(gim_status status);

/* What a caller is willing to decode. A member that is 0 stands for its default. */
typedef struct gim_limits {
    size_t size;             /* sizeof(gim_limits) */
    uint32_t max_grid;       /* samples a side, of all images; default 4097 */
    uint32_t max_sides;      /* sides of the seam; default 16384 */
    uint64_t max_workspace;  /* bytes; default 2 GiB */
} gim_limits;

typedef enum gim_coding {
    GIM_CODING_WAVELET = 0, /* lossy: wavelet coefficients of each component, quantised with one step */
    GIM_CODING_RAW12 = 1,   /* 12-bit integers over a common cube, coded without loss; always fused */
    GIM_CODING_FLOAT = 2,   /* the float32 samples themselves, coded without loss; always fused */
    GIM_CODING_SURFACE = 3, /* lossy: wavelet coefficients along the surface's normals and tangents, across
                               the seam; geometry only, and always fused */
    GIM_CODING_FIELD = 5    /* lossy: wavelet coefficients of what is spread over the surface, across the seam;
                               normals and attributes only, and always fused */
} gim_coding;

typedef struct gim_info {
    size_t size;             /* sizeof(gim_info), set by the caller */
    uint32_t version;        /* of the format */
    uint32_t grid;           /* samples a side of the geometry image, 2^j + 1, 3 to 4097 */
    uint32_t lowest;         /* samples a side of the lowest level of detail */
    uint32_t levels;         /* of detail; level 0 has `grid` samples a side, level levels-1 has `lowest` */
    gim_coding coding;       /* of the geometry */
    float step;              /* its quantisation step, in units of length; 0 in float coding */
    uint32_t normal_grid;    /* samples a side of the normal image; 0: the file has none */
    gim_coding normal_coding;/* meaningful if normal_grid is not 0 */
    float normal_step;
    uint32_t attributes;     /* how many, 0 to 16; for gim_read_attribute */
    uint32_t chunks;         /* for gim_read_chunk */
    uint64_t container_bytes;/* header, chunk headers, checksums and the fixed fields of the known chunks */
    uint64_t seam_bytes;     /* the seam's coded word */
    uint64_t geometry_bytes; /* the geometry's coded samples */
    uint64_t normal_bytes;   /* the normals' coded samples */
    uint64_t attribute_bytes;/* all attributes' coded samples */
    uint64_t other_bytes;    /* contents of chunks this version does not know; the six add up to the file */
    uint64_t workspace;      /* as gim_workspace_size */
    uint64_t missing_bytes;  /* of the geometry's coded samples, in a file that is cut short; otherwise 0 */
} gim_info;

/* Reads the headers of the file and checks all its checksums.
 * `limits` may be NULL: the defaults apply.
 * GIM_MORE_INPUT: the file is cut short. If info->grid is not 0 all the same, what is there can be decoded with
 * GIM_PREFIX; info then tells what the bytes that are there hold. */
GIM_API gim_status gim_probe(const void* bytes, size_t size, const gim_limits* limits, gim_info* info);

/* Bytes of workspace that are enough for every call on the probed file. 0 for a NULL info. */
GIM_API size_t gim_workspace_size(const gim_info* info);

typedef struct gim_chunk {
    size_t size;      /* sizeof(gim_chunk), set by the caller */
    char type;        /* 'S' seam, 'G' geometry, 'n' normals, 'a' attribute; small letter: may be skipped */
    uint64_t offset;  /* of the chunk's content in the file */
    uint64_t length;  /* of the content */
    uint64_t total;   /* with its header and checksum */
} gim_chunk;

/* The file's chunk number `index`, counted from 0 in file order.
 * GIM_MISUSE: there is no such chunk. */
GIM_API gim_status gim_read_chunk(const void* bytes, size_t size, uint32_t index, gim_chunk* chunk);

typedef enum gim_side_kind {
    GIM_SIDE_BOUNDARY = 0, /* a piece of the surface's own boundary: glued to nothing */
    GIM_SIDE_FIRST = 1,    /* the first occurrence of a cut-path */
    GIM_SIDE_MATE = 2      /* its second occurrence, run through in the reverse direction */
} gim_side_kind;

/* One side of the seam. Sides follow each other counter-clockwise around the border. */
typedef struct gim_side {
    uint32_t path;   /* label, 0, 1, 2.. by first occurrence; a mate has the label of its first */
    uint32_t length; /* in steps of the lowest level's grid */
    uint32_t kind;   /* gim_side_kind */
} gim_side;

typedef struct gim_seam {
    size_t size;             /* sizeof(gim_seam), set by the caller */
    uint32_t start;          /* border position where the first side begins, in steps of the lowest grid */
    uint32_t sides;          /* how many */
    uint32_t paths;          /* distinct labels */
    uint32_t cut_nodes;      /* distinct surface points where sides meet */
    uint32_t genus;          /* of the surface */
    uint32_t boundary_loops; /* of the surface; 0: it is closed */
} gim_seam;

/* Reads the seam, also of a file that is cut short after it and the geometry's first bytes. `sides` receives seam->sides entries; it may be NULL with capacity 0 to learn
 * the numbers only. The side count never exceeds 4 (lowest - 1).
 * GIM_MISUSE: `sides` is not NULL and `capacity` is too small; seam->sides is set all the same. */
GIM_API gim_status gim_read_seam(const void* bytes, size_t size, const gim_limits* limits, void* workspace,
                                 size_t workspace_size, gim_seam* seam, gim_side* sides, uint32_t capacity);

/* Flags for decoding. */
#define GIM_NO_FUSE 1u    /* leave glued samples as they were coded: shows the cracks; implies the next. Wavelet
                           * images only: the other codings code glued samples as one */
#define GIM_NO_DIFFUSE 2u /* fuse, but do not spread the fusing error into the interior */
#define GIM_PREFIX 4u     /* a file that is cut short will do, as far as gim_probe says so. Surface coding puts first
                             what tells most: the surface is coarser, and whole. What follows the cut is absent,
                             and the chunk that is cut has no checksum that could be compared */

/* Decodes the geometry image: `xyz` receives 3 * grid * grid floats, x y z of sample 0, of sample 1...
 * in the surface's own units. All are finite. Unless GIM_NO_FUSE is given, glued samples are equal.
 * GIM_MISUSE: unknown flags, or a workspace smaller than gim_workspace_size says. */
GIM_API gim_status gim_decode_geometry(const void* bytes, size_t size, const gim_limits* limits,
                                       uint32_t flags, void* workspace, size_t workspace_size, float* xyz);

/* Decodes the normal image: `normals` receives 3 * normal_grid * normal_grid floats, object-space
 * vectors. They are of unit length, except in float coding, where they are what was encoded.
 * GIM_MISUSE: the file has no normals. */
GIM_API gim_status gim_decode_normals(const void* bytes, size_t size, const gim_limits* limits,
                                      uint32_t flags, void* workspace, size_t workspace_size, float* normals);

#define GIM_MAX_CHANNELS 16
#define GIM_MAX_ATTRIBUTE_NAME 63 /* bytes */

typedef enum gim_sample_type {
    GIM_U8 = 0,  /* uint8_t */
    GIM_U16 = 1, /* uint16_t */
    GIM_F32 = 2  /* float */
} gim_sample_type;

/* An attribute: an image of its own of what is spread over the surface, as colours or weights. */
typedef struct gim_attribute {
    size_t size;            /* sizeof(gim_attribute), set by the caller */
    char name[GIM_MAX_ATTRIBUTE_NAME + 1]; /* UTF-8 without control characters, ended by 0; no two are equal */
    uint32_t grid;          /* samples a side, 2^j + 1, at least that of the lowest level */
    uint32_t channels;      /* 1 to 16 */
    gim_sample_type type;
    gim_coding coding;
    float step;             /* quantisation step, in units of the samples */
    uint32_t glued;         /* 1: samples that are glued are equal; 0: the border is open, as of texture
                               coordinates that jump there */
    uint32_t normalized;    /* 1: integers stand for fractions of the largest of their type */
    uint64_t coded_bytes;   /* its coded samples in the file */
    uint64_t decoded_bytes; /* what gim_decode_attribute writes: channels * grid * grid samples */
} gim_attribute;

/* What the file tells about its attribute number `index`, counted from 0 in file order.
 * GIM_MISUSE: there is no such attribute. */
GIM_API gim_status gim_read_attribute(const void* bytes, size_t size, const gim_limits* limits, uint32_t index,
                                      gim_attribute* attribute);

/* Decodes an attribute: `samples`, aligned as its type wants it, receives decoded_bytes bytes, the channels of
 * sample 0, of sample 1... Floats are finite.
 * An attribute's sample (i, j) lies where the geometry's (i, j) * (info.grid - 1) / (attribute.grid - 1) does.
 * GIM_MISUSE: there is no such attribute, or the workspace is smaller than gim_workspace_size says. */
GIM_API gim_status gim_decode_attribute(const void* bytes, size_t size, const gim_limits* limits,
                                        uint32_t index, void* workspace, size_t workspace_size, void* samples);

typedef struct gim_mesh_counts {
    size_t size;        /* sizeof(gim_mesh_counts), set by the caller */
    uint32_t grid;      /* samples a side at the level */
    uint32_t vertices;
    uint32_t triangles; /* 2 (grid - 1)^2 */
} gim_mesh_counts;

/* How large the mesh of a level of detail is. Level 0 is the finest. With GIM_NO_FUSE in `flags`
 * every sample is a vertex; otherwise glued samples are one vertex.
 * GIM_MISUSE: `level` is not below info.levels. */
GIM_API gim_status gim_mesh_size(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                                 uint32_t level, void* workspace, size_t workspace_size,
                                 gim_mesh_counts* counts);

/* Builds the mesh of a level of detail.
 * xyz               the decoded geometry, 3 * info.grid * info.grid floats: it decides the diagonals
 * vertex_of_sample  receives counts.grid^2 entries: the vertex of each sample of the level, by rows
 * sample_of_vertex  receives counts.vertices entries: a vertex's sample, numbered in the *finest* grid,
 *                   so that a vertex stands at xyz[3 * sample_of_vertex[v]]
 * triangles         receives 3 * counts.triangles vertex numbers, counter-clockwise in (s, t)
 * Any of the three may be NULL if it is not wanted.
 * Numbers are always in range. A file of a conforming encoder gives a manifold; one that was forged, checksums
 * and all, may not (SPEC.md, section 7). */
GIM_API gim_status gim_build_mesh(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                                  uint32_t level, void* workspace, size_t workspace_size, const float* xyz,
                                  uint32_t* vertex_of_sample, uint32_t* sample_of_vertex, uint32_t* triangles);

/* Normals of a level of detail, for files without a normal image: unit vectors, area-weighted means over the cells
 * around each sample of the level, across the seam too; (0, 0, 1) where the surface has no area.
 * xyz      the decoded geometry
 * normals  room for 3 * info.grid * info.grid floats; receives those of the level's samples, where `xyz` has
 *          them: a vertex v of gim_build_mesh has the normal at normals + 3 * sample_of_vertex[v] */
GIM_API gim_status gim_estimate_normals(const void* bytes, size_t size, const gim_limits* limits,
                                        uint32_t flags, uint32_t level, void* workspace,
                                        size_t workspace_size, const float* xyz, float* normals);

#ifdef __cplusplus
}
#endif

#endif
