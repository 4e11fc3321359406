/* What the depth of a sample does to registration, which knows but the plane of the plate: a registered session of the
 * virtual rig against the dataset that weft simulate makes of the same stitch (docs/notes/registration.md).
 * Usage: bench_parallax STITCH REGISTERED.btf.h5 SIMULATED.btf.h5 */
#include "bench/periodic_shift.h"
#include "btf/dataset/dataset.h"
#include "btf/direction/direction.h"
#include "geometry/light/stitch_sample.h"

#include <stdio.h>
#include <stdlib.h>

#define SAME_DIRECTION 0.999 /* cosine: a near camera sees the texels from directions that differ by a degree */

/* One of the two, whole. */
typedef struct whole_dataset {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    weft_half *samples; /* [height][width][image_count][3] */
} whole_dataset;

typedef struct bench {
    weft_stitch_sample *stitch;
    whole_dataset registered, simulated;
    double *one, *other, *sum_one, *sum_other, *frontal; /* [height][width] of the tile */
} bench;

/* What a view's images show. */
typedef struct view_figures {
    double square_difference, square, mean_registered, mean_simulated;
    int images;
} view_figures;

static weft_code open_whole(const char *path, whole_dataset *whole, weft_error *error)
{
    WEFT_TRY(weft_dataset_open(path, &whole->dataset, error));
    whole->layout = weft_dataset_get_layout(whole->dataset);
    int width = whole->layout->width, height = whole->layout->height;
    size_t bytes = (size_t)width * (size_t)height * (size_t)whole->layout->image_count * 3 * sizeof(weft_half);
    whole->samples = malloc(bytes);
    if (!whole->samples)
        return weft_fail_memory(error, path, bytes);
    return weft_dataset_read_block(whole->dataset, 0, 0, width, height, whole->samples, NULL, error);
}

static void close_whole(whole_dataset *whole)
{
    weft_dataset_close(whole->dataset);
    free(whole->samples);
}

/* The green image, all its tiles of width x height averaged. */
static void average_tiles(const whole_dataset *of, int image, int width, int height, double *tile)
{
    const weft_dataset_layout *layout = of->layout;
    double share = (double)width * height / ((double)layout->width * layout->height);
    for (int i = 0; i < width * height; i++)
        tile[i] = 0;
    for (int y = 0; y < layout->height; y++) {
        for (int x = 0; x < layout->width; x++) {
            size_t texel = (size_t)y * (size_t)layout->width + (size_t)x;
            weft_half green = of->samples[3 * (texel * (size_t)layout->image_count + (size_t)image) + 1];
            tile[y % height * width + x % width] += share * (double)weft_float_of_half(green);
        }
    }
}

static weft_vec3 view_of(const weft_dataset_layout *layout, int image)
{
    return weft_unit(layout->view[layout->view_of_image[image]]);
}

/* The image of the same light and view; -1 where there is none. */
static int find_same(const weft_dataset_layout *in, weft_vec3 light, weft_vec3 view)
{
    for (int i = 0; i < in->image_count; i++)
        if (weft_dot(in->light[i], light) > SAME_DIRECTION && weft_dot(view_of(in, i), view) > SAME_DIRECTION)
            return i;
    return -1;
}

static void add_pair(bench *b, int image, int same, view_figures *figures)
{
    int width = b->simulated.layout->width, height = b->simulated.layout->height;
    average_tiles(&b->registered, image, width, height, b->one);
    average_tiles(&b->simulated, same, width, height, b->other);
    for (int i = 0; i < width * height; i++) {
        double difference = b->one[i] - b->other[i];
        figures->square_difference += difference * difference;
        figures->square += b->other[i] * b->other[i];
        figures->mean_registered += b->one[i];
        figures->mean_simulated += b->other[i];
        b->sum_one[i] += b->one[i];
        b->sum_other[i] += b->other[i];
    }
    figures->images++;
}

/* Sums all lights of a view that both datasets have. */
static view_figures gather_view(bench *b, int view)
{
    const weft_dataset_layout *layout = b->registered.layout;
    view_figures figures = {0};
    for (int i = 0; i < b->simulated.layout->width * b->simulated.layout->height; i++)
        b->sum_one[i] = b->sum_other[i] = 0;
    for (int image = 0; image < layout->image_count; image++) {
        if (layout->view_of_image[image] != view)
            continue;
        int same = find_same(b->simulated.layout, weft_unit(layout->light[image]), view_of(layout, image));
        if (same >= 0)
            add_pair(b, image, same, &figures);
    }
    return figures;
}

/* Mean and standard deviation of the depth at which a view meets the cloth. */
static void find_depth(const weft_stitch_sample *sample, weft_vec3 view, double *mean, double *deviation)
{
    enum { PLACES = 128 };
    const weft_stitch *stitch = weft_stitch_sample_stitch(sample);
    double sum = 0, squares = 0;
    int count = 0;
    for (int i = 0; i < PLACES * PLACES; i++) {
        weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
        double x = (i % PLACES + 0.5) / PLACES * stitch->width, y = (i / PLACES + 0.5) / PLACES * stitch->height;
        if (weft_stitch_sample_see(sample, x, y, view, 0, 0, vertex) == 0)
            continue;
        double depth = (double)-vertex[0].at[2];
        sum += depth;
        squares += depth * depth;
        count++;
    }
    *mean = count ? sum / count : 0;
    *deviation = count ? sqrt(fmax(squares / count - *mean * *mean, 0)) : 0;
}

static weft_code print_view(bench *b, int view, const view_figures *f, weft_error *error)
{
    int width = b->simulated.layout->width, height = b->simulated.layout->height;
    double pitch = b->simulated.layout->texel_pitch_mm, depth, deviation;
    weft_vec3 direction = weft_unit(b->registered.layout->view[view]);
    weft_angles angles = weft_angles_of_direction(direction);
    periodic_shift against_truth, against_frontal;
    if (direction.z > SAME_DIRECTION)
        for (int i = 0; i < width * height; i++)
            b->frontal[i] = b->sum_one[i];
    WEFT_TRY(periodic_shift_find(b->sum_other, b->sum_one, width, height, &against_truth, error));
    WEFT_TRY(periodic_shift_find(b->frontal, b->sum_one, width, height, &against_frontal, error));
    find_depth(b->stitch, direction, &depth, &deviation);
    double slope = hypot(direction.x, direction.y) / direction.z;
    double along = slope > 0 ? (against_frontal.right * direction.x + against_frontal.up * direction.y) * pitch /
                                   hypot(direction.x, direction.y)
                             : 0;
    printf("%5.1f %6.1f  %8.3f %8.3f  %9.3f %8.2f  %10.3f  %8.4f %8.3f  %8.3f %7.3f\n",
           weft_deg_of_rad(angles.theta_rad), weft_deg_of_rad(angles.phi_rad), depth, deviation, depth * slope,
           deviation * slope / pitch, along, hypot(against_truth.right, against_truth.up) * pitch,
           against_truth.correlation, sqrt(f->square_difference / f->square), f->mean_registered / f->mean_simulated);
    return WEFT_OK;
}

static weft_code check_tiles(const bench *b, weft_error *error)
{
    const weft_dataset_layout *one = b->registered.layout, *tile = b->simulated.layout;
    if (one->width % tile->width != 0 || one->height % tile->height != 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%d x %d texels are not whole tiles of %d x %d", one->width,
                         one->height, tile->width, tile->height);
    return WEFT_OK;
}

static weft_code compare(bench *b, weft_error *error)
{
    size_t texels = (size_t)b->simulated.layout->width * (size_t)b->simulated.layout->height;
    WEFT_TRY(check_tiles(b, error));
    b->one = calloc(5 * texels, sizeof *b->one);
    if (!b->one)
        return weft_fail_memory(error, "tiles", 5 * texels * sizeof *b->one);
    b->other = b->one + texels;
    b->sum_one = b->one + 2 * texels;
    b->sum_other = b->one + 3 * texels;
    b->frontal = b->one + 4 * texels;
    printf("   view, deg    depth seen, mm     displaced by     against     against the simulation\n");
    printf("theta    phi      mean    s.d.    mean mm  s.d. texels  frontal mm  apart mm  correl.  rel. RMSE   mean\n");
    for (int view = 0; view < b->registered.layout->view_count; view++) {
        view_figures figures = gather_view(b, view);
        if (figures.images > 0)
            WEFT_TRY(print_view(b, view, &figures, error));
    }
    return WEFT_OK;
}

int main(int argc, char **argv)
{
    bench b = {0};
    weft_error error = {0};
    if (argc != 4) {
        fprintf(stderr, "usage: bench_parallax STITCH REGISTERED.btf.h5 SIMULATED.btf.h5\n");
        return 2;
    }
    weft_code code = weft_stitch_sample_read(argv[1], 0, &b.stitch, &error);
    if (code == WEFT_OK)
        code = open_whole(argv[2], &b.registered, &error);
    if (code == WEFT_OK)
        code = open_whole(argv[3], &b.simulated, &error);
    if (code == WEFT_OK)
        code = compare(&b, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_parallax: %s\n", error.message);
    close_whole(&b.registered);
    close_whole(&b.simulated);
    weft_stitch_sample_free(b.stitch);
    free(b.one);
    return code == WEFT_OK ? 0 : 1;
}
