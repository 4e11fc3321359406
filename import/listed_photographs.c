#include "import/far_photograph.h"
#include "import/readers.h"

#include "base/text/csv.h"
#include "base/text/image_list.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FILE_COLUMN, ANGLE_COLUMNS, COLUMN_COUNT = ANGLE_COLUMNS + 4 };

static const char *const column_name[COLUMN_COUNT] = {"file", "theta_light_deg", "phi_light_deg", "theta_view_deg",
                                                      "phi_view_deg"};

static weft_code find_columns(const weft_csv *table, int column[COLUMN_COUNT], weft_error *error)
{
    for (int i = 0; i < COLUMN_COUNT; i++) {
        column[i] = weft_csv_column(table, column_name[i]);
        if (column[i] < 0)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' has no column '%s'", table->path, column_name[i]);
    }
    return WEFT_OK;
}

/* A table from elsewhere must not make the import read files outside its folder. */
static bool stays_inside(const char *name)
{
    return name[0] && name[0] != '/' && strcmp(name, "..") != 0 && strncmp(name, "../", 3) != 0 &&
           !strstr(name, "/../");
}

static weft_code add_row(const char *folder, const weft_csv *table, int row, const int column[COLUMN_COUNT],
                         weft_collection *collection, weft_error *error)
{
    const char *name = weft_csv_text(table, row, column[FILE_COLUMN]);
    if (!stays_inside(name))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: '%s' is not a file inside the folder", table->path,
                         table->line[row], name);
    double angle_deg[4];
    for (int i = 0; i < 4; i++)
        WEFT_TRY(weft_csv_number(table, row, column[ANGLE_COLUMNS + i], &angle_deg[i], error));
    weft_named_angles angles = {{weft_rad_of_deg(angle_deg[0]), weft_rad_of_deg(angle_deg[1])},
                                {weft_rad_of_deg(angle_deg[2]), weft_rad_of_deg(angle_deg[3])}};
    char *path = weft_join_path(folder, name);
    if (!path)
        return weft_fail_memory(error, "path", strlen(folder) + strlen(name));
    bool missing = access(path, F_OK) != 0;
    free(path);
    return weft_collection_add_far(collection, name, missing, &angles, error);
}

/* Radians are small, and no rig turns through six degrees alone. */
static weft_code ask_for_radians(const weft_csv *table, const int column[COLUMN_COUNT], weft_collection *collection,
                                 weft_error *error)
{
    const int fewest = 4;
    double largest = 0, angle;
    for (int row = 0; row < table->row_count; row++) {
        for (int i = 0; i < 4; i++) {
            WEFT_TRY(weft_csv_number(table, row, column[ANGLE_COLUMNS + i], &angle, error));
            largest = fmax(largest, fabs(angle));
        }
    }
    if (table->row_count < fewest || largest == 0 || largest > 2 * WEFT_PI + 0.01)
        return WEFT_OK;
    return weft_lines_add(&collection->notes, error,
                          "'%s': its largest angle is %.3g degrees: if its angles are radians, convert them",
                          table->path, largest);
}

static weft_code add_rows(const char *folder, const weft_csv *table, weft_collection *collection, weft_error *error)
{
    int column[COLUMN_COUNT];
    WEFT_TRY(find_columns(table, column, error));
    for (int row = 0; row < table->row_count; row++)
        WEFT_TRY(add_row(folder, table, row, column, collection, error));
    return ask_for_radians(table, column, collection, error);
}

static int by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Names [count] in order: one that stands there twice has two lights or two views. */
static weft_code check_once(char *const *listed, size_t count, weft_error *error)
{
    for (size_t i = 1; i < count; i++) {
        if (strcmp(listed[i], listed[i - 1]) == 0)
            return weft_fail(error, WEFT_BAD_INPUT, "directions.csv lists '%s' twice", listed[i]);
    }
    return WEFT_OK;
}

/* Says which photographs the table does not list, and fails where it lists one twice. */
static weft_code note_unlisted(const char *folder, weft_collection *collection, weft_error *error)
{
    weft_lines images;
    WEFT_TRY(weft_images_list(folder, &images, error));
    size_t count = (size_t)collection->count;
    char **listed = malloc(count * sizeof *listed + 1);
    weft_code code = listed ? WEFT_OK : weft_fail_memory(error, "names", count * sizeof *listed);
    for (size_t i = 0; listed && i < count; i++)
        listed[i] = collection->photograph[i].name;
    if (listed) {
        qsort(listed, count, sizeof *listed, by_text);
        code = check_once(listed, count, error);
    }
    for (int i = 0; code == WEFT_OK && i < images.count; i++) {
        if (!bsearch(&images.line[i], listed, count, sizeof *listed, by_text))
            code = weft_lines_add(&collection->notes, error, "left out '%s': not in directions.csv", images.line[i]);
    }
    free(listed);
    weft_lines_free(&images);
    return code;
}

weft_code weft_collection_of_table(const char *folder, weft_collection *collection, weft_error *error)
{
    collection->kind = "photographs listed in directions.csv";
    collection->distance = WEFT_FAR;
    char *path = weft_join_path(folder, "directions.csv");
    if (!path)
        return weft_fail_memory(error, "path", strlen(folder));
    weft_csv table;
    weft_code code = weft_csv_read(path, true, &table, error);
    free(path);
    WEFT_TRY(code);
    code = add_rows(folder, &table, collection, error);
    weft_csv_free(&table);
    WEFT_TRY(code);
    WEFT_TRY(note_unlisted(folder, collection, error));
    return weft_collection_sort_far(collection, folder, error);
}
