/* How far the heights that are found in a dataset are from the surface of the stitch that it shows, whose texels lie on
 * the top face: of one tile, as weft simulate --plane top makes it, or of many, as the virtual rig photographs them
 * (docs/notes/geometry.md). Usage: bench_relief STITCH DATASET.btf.h5 */
#include "base/numeric/statistics.h"
#include "geometry/light/stitch_sample.h"
#include "relief/relief.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Height of the surface above its top face, seen straight from above; NAN in a hole. Right is x, up is y, mm. */
static double true_height_mm(const weft_stitch_sample *sample, double x_mm, double y_mm)
{
    weft_seen_vertex vertex[1 + WEFT_STITCH_SAMPLE_MAX_BOUNCES];
    int count = weft_stitch_sample_see(sample, x_mm, y_mm, weft_vec3_of(0, 0, 1), 1, 0, vertex);
    return count > 0 ? vertex[0].at[2] : NAN;
}

/* Distances of the places that are no holes, in `distance`; returns their number. */
static int distances(const weft_stitch_sample *sample, const weft_relief_report *found, double *distance)
{
    int count = 0;
    for (int i = 0; i < found->width * found->height; i++) {
        double x = (i % found->width + 0.5) / found->width * found->width_mm;
        double y = (1 - (i / found->width + 0.5) / found->height) * found->height_mm;
        double truth = true_height_mm(sample, x, y);
        if (isfinite(truth))
            distance[count++] = fabs((double)found->height_mm_of[i] - truth);
    }
    return count;
}

static const char *word_of(weft_relief_verdict verdict)
{
    return verdict == WEFT_RELIEF_HEIGHTS ? "relief" : verdict == WEFT_RELIEF_PLANE ? "plane" : "nothing";
}

static weft_code report(const weft_stitch_sample *sample, const weft_relief_report *found, weft_error *error)
{
    size_t places = (size_t)found->width * (size_t)found->height;
    double *distance = malloc(places * sizeof *distance);
    if (!distance)
        return weft_fail_memory(error, "distances of heights", places * sizeof *distance);
    int count = distances(sample, found, distance);
    printf("%d x %d places of %.3f mm, %d of them no holes; found from %.3f to %.3f mm\n", found->width, found->height,
           found->width_mm / found->width, count, found->low_mm, found->high_mm);
    if (count > 0) {
        double median = weft_quantile(distance, (size_t)count, 0.5), most = weft_quantile(distance, (size_t)count, 0.9);
        printf("distance from the surface: median %.4f mm, 90 %% within %.4f mm\n", median, most);
    }
    printf("views left out: flat %.3f, plane %.3f (%.3f mm), heights %.3f; decided: %s\n", found->error.flat,
           found->error.plane, found->plane_mm, found->error.heights, word_of(found->verdict));
    free(distance);
    return WEFT_OK;
}

static weft_code run(const char *stitch, const char *path, weft_error *error)
{
    const weft_relief_options options = {0};
    weft_stitch_sample *sample = NULL;
    weft_dataset *dataset = NULL;
    weft_relief_report found = {0};
    weft_code code = weft_stitch_sample_read(stitch, 0, &sample, error);
    if (code == WEFT_OK)
        code = weft_dataset_open(path, &dataset, error);
    if (code == WEFT_OK)
        code = weft_relief_estimate(dataset, &options, NULL, &found, error);
    if (code == WEFT_OK)
        code = report(sample, &found, error);
    weft_relief_report_free(&found);
    weft_dataset_close(dataset);
    weft_stitch_sample_free(sample);
    return code;
}

int main(int argc, char **argv)
{
    weft_error error = {0};
    if (argc != 3) {
        fprintf(stderr, "usage: bench_relief STITCH DATASET.btf.h5\n");
        return WEFT_BAD_USAGE;
    }
    weft_code code = run(argv[1], argv[2], &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_relief: %s\n", error.message);
    return (int)code;
}
