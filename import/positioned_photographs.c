/* A folder of flash photographs with the positions of camera and light, in the layout of the MaterialGAN collection
 * (Guo et al. 2020): centimetres, one line a photograph, origin at the centre of the photographed square. */
#include "import/readers.h"

#include "base/text/csv.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double mm_per_cm = 10;

static weft_code read_table(const char *folder, const char *name, int columns, weft_csv *table, weft_error *error)
{
    char *path = weft_join_path(folder, name);
    if (!path)
        return weft_fail_memory(error, "path", strlen(folder) + strlen(name));
    weft_code code = weft_csv_read(path, false, table, error);
    if (code == WEFT_OK && table->column_count != columns) {
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d numbers in a line, not %d", path, table->column_count,
                         columns);
        weft_csv_free(table);
    }
    free(path);
    return code;
}

static weft_code read_row(const weft_csv *table, int row, double value[3], weft_error *error)
{
    for (int i = 0; i < 3; i++)
        WEFT_TRY(weft_csv_number(table, row, i, &value[i], error));
    return WEFT_OK;
}

static weft_code read_position(const weft_csv *table, int row, weft_vec3 *position, weft_error *error)
{
    double cm[3];
    WEFT_TRY(read_row(table, row, cm, error));
    if (!(cm[2] > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: z = %g cm, but it must lie above the surface", table->path,
                         table->line[row], cm[2]);
    *position = weft_scale(weft_vec3_of(cm[0], cm[1], cm[2]), mm_per_cm);
    return WEFT_OK;
}

static weft_code read_intensity(const weft_csv *power, int row, weft_rgb *intensity, weft_error *error)
{
    double value[3];
    row = power->row_count == 1 ? 0 : row;
    WEFT_TRY(read_row(power, row, value, error));
    if (!(value[0] > 0 && value[1] > 0 && value[2] > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: the power of a light must be positive", power->path,
                         power->line[row]);
    /* pixel = BRDF cos power / d^2 with d in cm; here d is in mm. */
    double scale = mm_per_cm * mm_per_cm;
    *intensity = (weft_rgb){value[0] * scale, value[1] * scale, value[2] * scale};
    return WEFT_OK;
}

/* Names the file of photograph `index`; whichever format is there, else NN.png. */
static bool find_photograph(const char *folder, int index, char name[32])
{
    static const char *const extension[] = {"png", "jpg", "jpeg", "exr", "tif", "tiff"};
    for (size_t i = 0; i < sizeof extension / sizeof *extension; i++) {
        snprintf(name, 32, "%02d.%s", index, extension[i]);
        if (weft_folder_holds(folder, name))
            return true;
    }
    snprintf(name, 32, "%02d.png", index);
    return false;
}

typedef struct position_tables {
    weft_csv camera, light, power, side;
} position_tables;

static weft_code read_tables(const char *folder, position_tables *tables, weft_error *error)
{
    WEFT_TRY(read_table(folder, "camera_pos.txt", 3, &tables->camera, error));
    WEFT_TRY(read_table(folder, "light_pos.txt", 3, &tables->light, error));
    WEFT_TRY(read_table(folder, "light_power.txt", 3, &tables->power, error));
    WEFT_TRY(read_table(folder, "image_size.txt", 1, &tables->side, error));
    int count = tables->camera.row_count;
    if (tables->light.row_count != count)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d lines, but camera_pos.txt %d", tables->light.path,
                         tables->light.row_count, count);
    if (tables->power.row_count != 1 && tables->power.row_count != count)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has %d lines, not 1 or %d", tables->power.path,
                         tables->power.row_count, count);
    return WEFT_OK;
}

static weft_code read_side(const weft_csv *table, double *side_mm, weft_error *error)
{
    WEFT_TRY(weft_csv_number(table, 0, 0, side_mm, error));
    if (!(*side_mm > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "%s: a side of %g cm", table->path, *side_mm);
    *side_mm *= mm_per_cm;
    return WEFT_OK;
}

static weft_code add_photographs(const char *folder, const position_tables *tables, weft_collection *collection,
                                 weft_error *error)
{
    for (int i = 0; i < tables->camera.row_count; i++) {
        char name[32];
        weft_photograph photograph = {.missing = !find_photograph(folder, i, name)};
        WEFT_TRY(read_position(&tables->light, i, &photograph.light, error));
        WEFT_TRY(read_position(&tables->camera, i, &photograph.view, error));
        WEFT_TRY(read_intensity(&tables->power, i, &photograph.intensity, error));
        WEFT_TRY(weft_collection_add(collection, name, photograph, error));
    }
    return WEFT_OK;
}

weft_code weft_collection_of_positions(const char *folder, weft_collection *collection, weft_error *error)
{
    collection->kind = "photographs with positions of light and camera";
    collection->distance = WEFT_NEAR;
    position_tables tables = {0};
    weft_code code = read_tables(folder, &tables, error);
    if (code == WEFT_OK)
        code = read_side(&tables.side, &collection->side_mm, error);
    if (code == WEFT_OK)
        code = add_photographs(folder, &tables, collection, error);
    weft_csv_free(&tables.camera);
    weft_csv_free(&tables.light);
    weft_csv_free(&tables.power);
    weft_csv_free(&tables.side);
    return code;
}
