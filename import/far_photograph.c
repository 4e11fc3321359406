#include "import/far_photograph.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

weft_code weft_collection_add_far(weft_collection *collection, const char *name, int missing,
                                  const weft_named_angles *angles, weft_error *error)
{
    const weft_real horizon_rad = WEFT_PI / 2 - 1e-6;
    const weft_angles *both[] = {&angles->light, &angles->view};
    for (int i = 0; i < 2; i++) {
        if (!(both[i]->theta_rad >= 0 && both[i]->theta_rad < horizon_rad))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': theta of the %s is %g degrees, not in [0, 90)", name,
                             i ? "view" : "light", weft_deg_of_rad(both[i]->theta_rad));
    }
    weft_photograph photograph = {.missing = missing,
                                  .light = weft_direction_of_angles(angles->light),
                                  .view = weft_direction_of_angles(angles->view)};
    return weft_collection_add(collection, name, photograph, error);
}

/* Orders directions; those nearer than the rounding of angles in files are one. */
static int compare_directions(weft_vec3 a, weft_vec3 b)
{
    const weft_real tolerance = 1e-7;
    weft_real difference[3] = {b.z - a.z, a.x - b.x, a.y - b.y};
    for (int i = 0; i < 3; i++) {
        if (fabs(difference[i]) > tolerance)
            return difference[i] < 0 ? -1 : 1;
    }
    return 0;
}

static int by_view_then_light(const void *a, const void *b)
{
    const weft_photograph *p = a, *q = b;
    int order = compare_directions(p->view, q->view);
    return order ? order : compare_directions(p->light, q->light);
}

static int by_direction(const void *a, const void *b)
{
    return compare_directions(*(const weft_vec3 *)a, *(const weft_vec3 *)b);
}

/* Of one light and view those come first that are there, then by name. */
static int in_order(const void *a, const void *b)
{
    const weft_photograph *p = a, *q = b;
    int order = by_view_then_light(p, q);
    if (order == 0)
        order = p->missing - q->missing;
    return order ? order : strcmp(p->name, q->name);
}

/* Takes `duplicate` out of the collection, or fails: it has the light and view of `kept`. A copy says nothing new. */
static weft_code leave_out(weft_collection *collection, const char *folder, const weft_photograph *kept,
                           weft_photograph *duplicate, weft_error *error)
{
    bool is_copy = weft_folder_holds_copies(folder, kept->name, duplicate->name);
    if (!collection->leaves_out_doubles && !is_copy)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': '%s' and '%s' have the same light and view (--skip-bad keeps one)", folder, kept->name,
                         duplicate->name);
    WEFT_TRY(weft_lines_add(&collection->notes, error, "left out '%s': it %s '%s'", duplicate->name,
                            is_copy ? "is a copy of" : "has the light and view of", kept->name));
    free(duplicate->name);
    duplicate->name = NULL;
    return WEFT_OK;
}

weft_code weft_collection_sort_far(weft_collection *collection, const char *folder, weft_error *error)
{
    weft_photograph *photograph = collection->photograph;
    if (collection->count == 0)
        return WEFT_OK;
    qsort(photograph, (size_t)collection->count, sizeof *photograph, in_order);
    int kept = 0;
    for (int i = 1; i < collection->count; i++) {
        const weft_photograph *last = &photograph[kept];
        if (by_view_then_light(last, &photograph[i]) == 0) {
            WEFT_TRY(leave_out(collection, folder, last, &photograph[i], error));
            continue;
        }
        /* One view, also where one name says 0 and another 360 degrees. */
        if (compare_directions(last->view, photograph[i].view) == 0)
            photograph[i].view = last->view;
        kept++;
        if (kept < i) {
            photograph[kept] = photograph[i];
            photograph[i].name = NULL;
        }
    }
    collection->count = kept + 1;
    return WEFT_OK;
}

/* The distinct directions of one kind, sorted, in new memory; NULL where memory is short. */
static weft_vec3 *distinct(const weft_collection *collection, bool views, int *count)
{
    weft_vec3 *direction = malloc((size_t)collection->count * sizeof *direction);
    if (!direction)
        return NULL;
    for (int i = 0; i < collection->count; i++)
        direction[i] = views ? collection->photograph[i].view : collection->photograph[i].light;
    qsort(direction, (size_t)collection->count, sizeof *direction, by_direction);
    *count = 1;
    for (int i = 1; i < collection->count; i++) {
        if (by_direction(&direction[i], &direction[*count - 1]) != 0)
            direction[(*count)++] = direction[i];
    }
    return direction;
}

static weft_code add_missing(weft_collection *collection, weft_vec3 light, weft_vec3 view, weft_error *error)
{
    weft_named_angles angles = {weft_angles_of_direction(light), weft_angles_of_direction(view)};
    char name[64];
    weft_angle_name_write(&angles, name);
    weft_photograph photograph = {.missing = true, .light = light, .view = view};
    return weft_collection_add(collection, name, photograph, error);
}

static weft_code fill_grid(weft_collection *collection, const weft_vec3 *light, int light_count, const weft_vec3 *view,
                           int view_count, weft_error *error)
{
    int present = collection->count, next = 0;
    for (int v = 0; v < view_count; v++) {
        for (int l = 0; l < light_count; l++) {
            const weft_photograph wanted = {.light = light[l], .view = view[v]};
            if (next < present && by_view_then_light(&collection->photograph[next], &wanted) == 0)
                next++;
            else
                WEFT_TRY(add_missing(collection, light[l], view[v], error));
        }
    }
    return WEFT_OK;
}

weft_code weft_collection_complete_grid(weft_collection *collection, weft_error *error)
{
    if (collection->count == 0)
        return WEFT_OK;
    int light_count = 0, view_count = 0;
    weft_vec3 *light = distinct(collection, false, &light_count);
    weft_vec3 *view = distinct(collection, true, &view_count);
    weft_code code = WEFT_OK;
    if (!light || !view)
        code = weft_fail_memory(error, "directions", (size_t)collection->count * sizeof *light);
    else if (collection->count >= 0.9 * light_count * (double)view_count)
        code = fill_grid(collection, light, light_count, view, view_count, error);
    free(light);
    free(view);
    return code;
}
