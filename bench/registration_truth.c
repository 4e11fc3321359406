/* How far a registered session of the virtual rig is from its ground truth, by ring of views: its warps, and its
 * reflectance. Usage: bench_truth SESSION DATASET.btf.h5 SESSION.truth.h5 */
#include "base/numeric/statistics.h"
#include "btf/session/session.h"
#include "tests/support/ground_truth.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>

enum { RINGS = 6, RING_DEG = 15, LAST_RING_OF_FLOOR = 45 / RING_DEG };

typedef struct warp {
    int ring;
    bool found;
    double error_texels;
} warp;

typedef struct bench {
    weft_session session;
    weft_dataset *dataset;
    truth real;
    truth_errors errors;
    int warp_count;
    warp *warp;
    double *pool; /* room for all errors of the warps or of the reflectance */
} bench;

static int ring_of_view(const bench *b, int view)
{
    return weft_ubo81_ring(weft_angles_of_direction(weft_dataset_get_layout(b->dataset)->view[view]).theta_rad);
}

/* ---- Warps: registration keeps them in the provenance of its dataset ---- */

static bool measure_warp(const bench *b, json_t *packed, warp *result)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(b->dataset);
    weft_homography found;
    double(*m)[3] = found.m;
    int view, viewpoint, used;
    if (json_unpack(packed, "{si si si s[[FFF][FFF][FFF]]}", "view", &view, "stay", &viewpoint, "used", &used,
                    "plate_mm_to_undistorted_pixels", &m[0][0], &m[0][1], &m[0][2], &m[1][0], &m[1][1], &m[1][2],
                    &m[2][0], &m[2][1], &m[2][2]) != 0 ||
        view < 0 || view >= layout->view_count || viewpoint < 0 || viewpoint >= b->real.viewpoint_count)
        return false;
    *result = (warp){.ring = ring_of_view(b, view), .found = used > 0};
    if (result->found)
        result->error_texels = truth_warp_error_texels(&b->real, &b->session.camera, viewpoint, &found, layout->width);
    return true;
}

static weft_code measure_warps(bench *b, weft_error *error)
{
    json_t *root = json_loads(weft_dataset_get_layout(b->dataset)->provenance, 0, NULL);
    json_t *viewpoints = json_object_get(root, "stays");
    size_t count = json_array_size(viewpoints);
    bool good = count > 0;
    b->warp = calloc(count + 1, sizeof *b->warp);
    for (size_t i = 0; b->warp && good && i < count; i++)
        good = measure_warp(b, json_array_get(viewpoints, i), &b->warp[i]);
    b->warp_count = (int)count;
    json_decref(root);
    if (!b->warp)
        return weft_fail_memory(error, "warps", count * sizeof *b->warp);
    if (!good)
        return weft_fail(error, WEFT_BAD_INPUT, "the provenance of '%s' does not hold the warps of this session",
                         weft_dataset_path(b->dataset));
    return WEFT_OK;
}

static void print_warps(const bench *b, int first_ring, int last_ring)
{
    int count = 0, found = 0;
    for (int i = 0; i < b->warp_count; i++) {
        if (b->warp[i].ring < first_ring || b->warp[i].ring > last_ring)
            continue;
        count++;
        if (b->warp[i].found)
            b->pool[found++] = b->warp[i].error_texels;
    }
    printf("%4d of %-3d %8.4f %8.4f", found, count, weft_quantile(b->pool, found, 0.5),
           weft_quantile(b->pool, found, 1));
}

/* ---- Reflectance ---- */

/* Errors of the images in the rings, of all texels or of the outermost, into the pool; returns their number. */
static int pool_errors(const bench *b, int first_ring, int last_ring, const int *of_image, const double *error,
                       int *images)
{
    int count = 0;
    *images = 0;
    for (int image = 0; image < b->real.image_count; image++) {
        int view = weft_dataset_get_layout(b->dataset)->view_of_image[b->real.image_shot[image]];
        int ring = ring_of_view(b, view);
        if (ring < first_ring || ring > last_ring)
            continue;
        for (int i = 0; i < of_image[image]; i++)
            b->pool[count++] = error[(size_t)image * (size_t)b->errors.capacity + (size_t)i];
        ++*images;
    }
    return count;
}

static void print_reflectance(const bench *b, int first_ring, int last_ring)
{
    int images, size = b->real.size;
    int count = pool_errors(b, first_ring, last_ring, b->errors.count, b->errors.error, &images);
    double all = (double)images * b->errors.capacity;
    printf("%14d %8.1f %% %8.2f %%", images, images ? 100 * count / all : 0, 100 * weft_quantile(b->pool, count, 0.5));
    count = pool_errors(b, first_ring, last_ring, b->errors.border_count, b->errors.border_error, &images);
    all = 3.0 * images * (size > 1 ? 4 * (size - 1) : 1);
    printf(" %8.1f %% %8.2f %% %8.1f %%", images ? 100 * count / all : 0, 100 * weft_quantile(b->pool, count, 0.5),
           100 * weft_quantile(b->pool, count, 0.9));
}

/* ---- Table ---- */

static void print_row(const bench *b, const char *name, int first_ring, int last_ring)
{
    printf("%-16s", name);
    print_warps(b, first_ring, last_ring);
    print_reflectance(b, first_ring, last_ring);
    printf("\n");
}

static void print_table(const bench *b)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(b->dataset);
    printf("%s: %d x %d texels of %.3f mm, %d photographs\n\n", weft_dataset_path(b->dataset), layout->width,
           layout->height, layout->texel_pitch_mm, layout->image_count);
    printf("%-16s%-29s     %-31s %s\n", "", "warps: RMS error, texels", "reflectance: relative error",
           "of the outermost texels");
    printf("%-16s%11s %8s %8s%14s %10s %10s %10s %10s %10s\n", "view", "found", "median", "worst", "photographs",
           "compared", "median", "compared", "median", "90 %");
    for (int ring = 0; ring < RINGS; ring++) {
        char name[32];
        snprintf(name, sizeof name, "%d degrees", ring * RING_DEG);
        print_row(b, name, ring, ring);
    }
    print_row(b, "up to 45", 0, LAST_RING_OF_FLOOR);
    print_row(b, "all", 0, RINGS - 1);
}

static weft_code run(bench *b, char **path, weft_error *error)
{
    WEFT_TRY(weft_session_open(path[0], &b->session, error));
    WEFT_TRY(weft_dataset_open(path[1], &b->dataset, error));
    WEFT_TRY(truth_read(path[2], &b->real, error));
    WEFT_TRY(truth_compare_reflectance(&b->real, b->dataset, &b->errors, error));
    WEFT_TRY(measure_warps(b, error));
    size_t room = (size_t)b->real.image_count * (size_t)b->errors.capacity + (size_t)b->warp_count;
    b->pool = malloc(room * sizeof *b->pool);
    if (!b->pool)
        return weft_fail_memory(error, "errors", room * sizeof *b->pool);
    print_table(b);
    return WEFT_OK;
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: bench_truth SESSION DATASET.btf.h5 SESSION.truth.h5\n");
        return WEFT_BAD_USAGE;
    }
    bench b = {0};
    weft_error error = {0};
    weft_code code = run(&b, argv + 1, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_truth: %s\n", error.message);
    free(b.pool);
    free(b.warp);
    truth_errors_free(&b.errors);
    truth_free(&b.real);
    weft_dataset_close(b.dataset);
    weft_session_free(&b.session);
    return (int)code;
}
