#include "btf/dataset/dataset.h"

#include <stdlib.h>
#include <string.h>

weft_code weft_dataset_layout_allocate(weft_dataset_layout *layout, weft_error *error)
{
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    layout->light = calloc(images, sizeof *layout->light);
    layout->view = calloc(views, sizeof *layout->view);
    layout->view_of_image = calloc(images, sizeof *layout->view_of_image);
    layout->provenance = strdup("{}");
    memset(layout->figure, 0, sizeof layout->figure);
    if (layout->light && layout->view && layout->view_of_image && layout->provenance)
        return WEFT_OK;
    weft_dataset_layout_free(layout);
    return weft_fail_memory(error, "layout of a dataset", (images + views) * sizeof *layout->light);
}

weft_code weft_dataset_layout_allocate_figure(weft_dataset_layout *layout, weft_image_figure figure, weft_error *error)
{
    size_t images = (size_t)layout->image_count;
    layout->figure[figure] = calloc(images, sizeof *layout->figure[figure]);
    return layout->figure[figure] ? WEFT_OK : weft_fail_memory(error, "figures of images", images * sizeof(double));
}

void weft_dataset_layout_free(weft_dataset_layout *layout)
{
    for (int i = 0; i < WEFT_IMAGE_FIGURES; i++) {
        free(layout->figure[i]);
        layout->figure[i] = NULL;
    }
    free(layout->light);
    free(layout->view);
    free(layout->view_of_image);
    free(layout->provenance);
    layout->light = layout->view = NULL;
    layout->view_of_image = NULL;
    layout->provenance = NULL;
}

double weft_dataset_texel_aspect(const weft_dataset_layout *layout)
{
    return layout->texel_aspect > 0 ? layout->texel_aspect : 1;
}

void weft_dataset_size_mm(const weft_dataset_layout *layout, double size_mm[2])
{
    double root = sqrt(weft_dataset_texel_aspect(layout));
    size_mm[0] = layout->width * layout->texel_pitch_mm * root;
    size_mm[1] = layout->height * layout->texel_pitch_mm / root;
}

static weft_vec3 direction_from_texel(const weft_dataset_layout *layout, weft_vec3 place, int x, int y)
{
    if (layout->distance == WEFT_FAR)
        return place;
    double pitch = layout->texel_pitch_mm;
    weft_vec3 texel = {(x + 0.5 - layout->width / 2.0) * pitch, (layout->height / 2.0 - y - 0.5) * pitch, 0};
    return weft_unit(weft_subtract(place, texel));
}

weft_vec3 weft_dataset_light_direction(const weft_dataset_layout *layout, int image, int x, int y)
{
    return direction_from_texel(layout, layout->light[image], x, y);
}

weft_vec3 weft_dataset_view_direction(const weft_dataset_layout *layout, int view, int x, int y)
{
    return direction_from_texel(layout, layout->view[view], x, y);
}

int weft_dataset_rows_at_once(const weft_dataset_layout *layout)
{
    size_t row = (size_t)layout->width * (size_t)layout->image_count * 3 * sizeof(weft_half);
    size_t rows = ((size_t)64 << 20) / row;
    return rows < 1 ? 1 : rows > (size_t)layout->height ? layout->height : (int)rows;
}
