#include "player/raw/relief.h"

#include <stdlib.h>

/* The views that have a tile, in the order of the tiles. */
static int tiled_views(const weft_raw_images *images, const weft_dataset_layout *layout, weft_vec3 *view)
{
    int count = 0;
    for (int v = 0; v < images->view_count; v++)
        if (images->first_of_view[v] < images->first_of_view[v + 1])
            view[count++] = layout->view[v];
    return count;
}

weft_code weft_raw_relief_make(weft_dataset *dataset, const weft_raw_images *images, weft_relief_map *relief,
                               weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_dataset_heights heights;
    double size_mm[2];
    *relief = (weft_relief_map){0};
    WEFT_TRY(weft_dataset_read_surface(dataset, &heights, error));
    if (!heights.value)
        return WEFT_OK;
    weft_vec3 *view = malloc((size_t)layout->view_count * sizeof *view);
    weft_dataset_size_mm(layout, size_mm);
    weft_height_field field =
        weft_height_field_of(heights.value, heights.width, heights.height, size_mm[0], size_mm[1]);
    weft_code code =
        view ? weft_relief_map_make(&field, view, tiled_views(images, layout, view), heights.level_count, relief, error)
             : weft_fail_memory(error, "views", (size_t)layout->view_count * sizeof *view);
    free(view);
    weft_dataset_heights_free(&heights);
    return code;
}
