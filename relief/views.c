#include "relief/features.h"

#include "base/integers.h"

#include <stdbool.h>
#include <stdlib.h>

enum { LEAST_VIEWS = 8 };

/* Of five degrees: a rig moves the lights that the camera would hide or that would blind it. Further apart, the shading
 * differs more than the parallax explains. */
#define SAME_LIGHT_COSINE 0.99619469809

/* Numbers of the images of a view; returns how many. */
static int images_of_view(const weft_dataset_layout *layout, int view, int *image)
{
    int count = 0;
    for (int i = 0; i < layout->image_count; i++)
        if (layout->view_of_image[i] == view)
            image[count++] = i;
    return count;
}

/* The view with most images, the first of several. */
static int fullest_view(const weft_dataset_layout *layout, int *scratch)
{
    int best = 0, most = 0;
    for (int view = 0; view < layout->view_count; view++) {
        int count = images_of_view(layout, view, scratch);
        if (count > most) {
            best = view;
            most = count;
        }
    }
    return best;
}

/* The image among `candidate` whose light is nearest to a direction; -1 where none is near enough. */
static int image_lit_from(const weft_dataset_layout *layout, const int *candidate, int count, weft_vec3 light)
{
    int best = -1;
    double nearest = SAME_LIGHT_COSINE;
    for (int i = 0; i < count; i++) {
        double cosine = weft_dot(layout->light[candidate[i]], light);
        if (cosine >= nearest) {
            nearest = cosine;
            best = candidate[i];
        }
    }
    return best;
}

static void choose_lights(const weft_dataset_layout *layout, weft_relief_views *views, weft_vec3 *light, int *scratch)
{
    int count = images_of_view(layout, fullest_view(layout, scratch), scratch);
    views->light_count = weft_smaller(count, WEFT_MOST_LIGHTS);
    for (int i = 0; i < views->light_count; i++) {
        light[i] = layout->light[scratch[(long)i * count / views->light_count]];
        views->cosine[i] = layout->values == WEFT_REFLECTANCE ? (float)light[i].z : 1;
    }
}

/* The images of a view under all lights; false where one is missing. */
static bool match_view(const weft_dataset_layout *layout, int view, const weft_vec3 *light, int light_count,
                       int *scratch, int *image)
{
    int count = images_of_view(layout, view, scratch);
    for (int i = 0; i < light_count; i++) {
        image[i] = image_lit_from(layout, scratch, count, light[i]);
        if (image[i] < 0)
            return false;
    }
    return true;
}

static weft_code match_views(const weft_dataset_layout *layout, const char *path, weft_relief_views *views,
                             weft_error *error)
{
    weft_vec3 light[WEFT_MOST_LIGHTS];
    int *scratch = malloc((size_t)layout->image_count * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "images of a view", (size_t)layout->image_count * sizeof *scratch);
    choose_lights(layout, views, light, scratch);
    for (int view = 0; view < layout->view_count; view++) {
        int *image = views->image + (long)views->view_count * views->light_count;
        if (!match_view(layout, view, light, views->light_count, scratch, image))
            continue;
        views->direction[views->view_count++] = layout->view[view];
    }
    free(scratch);
    if (views->view_count < LEAST_VIEWS)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s': %d of %d views were photographed under the same %d lights; heights need %d", path,
                         views->view_count, layout->view_count, views->light_count, LEAST_VIEWS);
    return WEFT_OK;
}

weft_code weft_relief_views_find(const weft_dataset_layout *layout, const char *path, weft_relief_views *views,
                                 weft_error *error)
{
    *views = (weft_relief_views){0};
    if (layout->distance == WEFT_NEAR)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has near lights and views: heights need views from far", path);
    size_t count = (size_t)layout->view_count, bytes = count * WEFT_MOST_LIGHTS * sizeof *views->image;
    views->direction = malloc(count * sizeof *views->direction);
    views->image = malloc(bytes);
    views->cosine = malloc(WEFT_MOST_LIGHTS * sizeof *views->cosine);
    weft_code code = WEFT_OK;
    if (!views->direction || !views->image || !views->cosine)
        code = weft_fail_memory(error, "views", bytes);
    if (code == WEFT_OK)
        code = match_views(layout, path, views, error);
    if (code != WEFT_OK)
        weft_relief_views_free(views);
    return code;
}

void weft_relief_views_free(weft_relief_views *views)
{
    free(views->direction);
    free(views->image);
    free(views->cosine);
    *views = (weft_relief_views){0};
}
