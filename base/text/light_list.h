/* Lists of lamps, one for each photograph: .lp files of reflectance transformation imaging, and tables.
 *
 * An .lp file holds the number of photographs, then a line for each: its name and x, y, z of the lamp, apart by blanks,
 * or by commas or semicolons. x points to the right of the picture, y up, z to the camera
 * (docs/reference/light-lists.md). A table has a header and holds file, then x, y, z or theta_light_deg, phi_light_deg,
 * or theta_view_deg, phi_view_deg, or both. */
#ifndef WEFT_BASE_TEXT_LIGHT_LIST_H
#define WEFT_BASE_TEXT_LIGHT_LIST_H

#include "base/text/lines.h"
#include "base/vector.h"

#include <stdbool.h>

/* What is listed of one photograph. */
typedef struct weft_listed_light {
    char *file; /* its name without folders, those of other computers included */
    int line;   /* of the list, from 1 */
    bool has_light, has_view;
    weft_vec3 light;        /* as listed: a direction or a position */
    weft_vec3 view;         /* unit */
    double uncertainty_deg; /* standard error of the light, as listed; 0: not said */
} weft_listed_light;

/* Owned by the caller, freed with weft_light_list_free. */
typedef struct weft_light_list {
    char *path;       /* for messages */
    bool of_pictures; /* an .lp file: in the frame of each picture; else in that of the sample */
    bool positions;   /* lights are positions in mm: half of them are 20 mm long or more; else unit vectors */
    int count;
    weft_listed_light *row; /* [count] */
    weft_lines notes;       /* what the reader of a report should know of the list, a line each */
} weft_light_list;

/* Reads a table where the name ends in .csv, else an .lp file. Empty lines and comments are passed over. Notes another
 * count than an .lp file says, and vectors that are taken for directions though they are not as long as one. Errors:
 * WEFT_BAD_INPUT "PATH:LINE: ..." for a row that is none, decimal commas, a lamp at the origin, or a file listed twice;
 * WEFT_SYSTEM for memory. Thread-safe. */
weft_code weft_light_list_read(const char *path, weft_light_list *list, weft_error *error);
void weft_light_list_free(weft_light_list *list);

/* The row of a photograph, by its name without folders and in any case; if no row has its ending, by the only row with
 * the rest of the name: lists are made of copies. -1 where there is none. Pure. */
int weft_light_list_find(const weft_light_list *list, const char *photograph);

#endif
