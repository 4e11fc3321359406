#include "bench/fit/texels.h"
#include "btf/direction/direction.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ROWS = 1 << 20, MAX_ANGLES = 64 };

typedef struct tape_row {
    double light_rad, a_rad, b_rad, value;
} tape_row;

typedef struct tape {
    tape_row *row;
    int count, angle_count;
    double angle_rad[MAX_ANGLES];
} tape;

static int angle_index(const tape *from, double light_rad)
{
    int index = 0;
    while (index < from->angle_count && fabs(from->angle_rad[index] - light_rad) > 1e-6)
        index++;
    return index;
}

static weft_code add_row(const char *path, const char *line, tape *to, weft_error *error)
{
    tape_row row;
    if (line[0] == '#')
        return WEFT_OK;
    if (sscanf(line, "%lf %lf %lf %lf", &row.light_rad, &row.a_rad, &row.b_rad, &row.value) != 4)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': row %d does not hold four numbers", path, to->count + 1);
    int angle = angle_index(to, row.light_rad);
    if (to->count == MAX_ROWS || angle == MAX_ANGLES)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': more than %d rows or %d angles of the light", path, MAX_ROWS,
                         MAX_ANGLES);
    if (angle == to->angle_count)
        to->angle_rad[to->angle_count++] = row.light_rad;
    to->row[to->count++] = row;
    return WEFT_OK;
}

static weft_code read_rows(const char *path, tape *to, weft_error *error)
{
    FILE *file = fopen(path, "r");
    char line[512];
    if (!file)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': %s", path, strerror(errno));
    weft_code code = WEFT_OK;
    while (code == WEFT_OK && fgets(line, sizeof line, file))
        code = add_row(path, line, to, error);
    fclose(file);
    if (code == WEFT_OK && to->count == 0)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s': no rows", path);
    return code;
}

/* (a, b) is the azimuth relative to the light with the polar angle for its length. */
static weft_vec3 view_of_row(const tape_row *row)
{
    double theta_rad = hypot(row->a_rad, row->b_rad);
    double scale = theta_rad > 0 ? sin(theta_rad) / theta_rad : 1;
    return weft_vec3_of(row->a_rad * scale, row->b_rad * scale, cos(theta_rad));
}

static weft_code lay_out(const tape *from, texel_source *source, weft_error *error)
{
    weft_dataset_layout *layout = &source->layout;
    *layout = (weft_dataset_layout){
        .width = 1, .height = 1, .image_count = from->count, .view_count = from->angle_count, .texel_pitch_mm = 1};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int i = 0; i < from->angle_count; i++)
        layout->view[i] = weft_vec3_of(sin(from->angle_rad[i]), 0, cos(from->angle_rad[i]));
    for (int i = 0; i < from->count; i++) {
        layout->light[i] = view_of_row(&from->row[i]);
        layout->view_of_image[i] = angle_index(from, from->row[i].light_rad);
    }
    WEFT_TRY(weft_bundle_create(layout, NULL, &source->bundle, error));
    return weft_samples_create(&source->bundle, &source->samples, error);
}

static weft_code gather(const tape *from, texel_source *source, weft_error *error)
{
    size_t count = (size_t)from->count;
    source->sum = calloc(3 * count, sizeof *source->sum);
    source->count = calloc(count, sizeof *source->count);
    if (!source->sum || !source->count)
        return weft_fail_memory(error, "samples of the tape", 4 * count * sizeof(float));
    for (size_t i = 0; i < count; i++) {
        source->count[i] = 1;
        for (int k = 0; k < 3; k++)
            source->sum[3 * i + (size_t)k] = (float)from->row[i].value;
    }
    weft_samples_gather(&source->bundle, WEFT_REFLECTANCE_COSINE, source->sum, source->count, 1, &source->samples);
    return WEFT_OK;
}

weft_code texel_source_open_tape(const char *path, texel_source *source, weft_error *error)
{
    *source = (texel_source){.name = "retro-reflective tape"};
    tape rows = {.row = malloc(MAX_ROWS * sizeof *rows.row)};
    weft_code code = rows.row ? read_rows(path, &rows, error) : weft_fail_memory(error, "rows", MAX_ROWS);
    if (code == WEFT_OK)
        code = lay_out(&rows, source, error);
    if (code == WEFT_OK)
        code = gather(&rows, source, error);
    free(rows.row);
    return code;
}
