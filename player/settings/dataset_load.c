#include "player/settings/dataset_load.h"

#include "player/draw/player_parts.h"

#include <stdlib.h>

struct weft_dataset_load {
    weft_player *player;
    weft_raw_limits limits;
    weft_raw_texture texture; /* of the drawing thread */
    double last_ring_z[2];
    weft_load *background;
};

weft_code weft_dataset_load_create(weft_player *player, weft_raw_format format, weft_dataset_load **result,
                                   weft_error *error)
{
    *result = calloc(1, sizeof **result);
    if (!*result)
        return weft_fail_memory(error, "load", sizeof **result);
    (*result)->player = player;
    (*result)->limits = weft_raw_texture_limits(format);
    return WEFT_OK;
}

void weft_dataset_load_free(weft_dataset_load *load)
{
    if (!load)
        return;
    weft_raw_texture_free(&load->texture);
    free(load);
}

/* ---- Pieces: handed over by the reader, run in the drawing thread ---- */

typedef struct beginning {
    weft_dataset_load *load;
    weft_raw_plan plan;
    weft_direction_map directions;
    weft_relief_map relief;
} beginning;

typedef struct row {
    weft_dataset_load *load;
    weft_raw_strip strip;
} row;

static weft_code run_beginning(void *data, weft_error *error)
{
    const beginning *b = data;
    return weft_raw_texture_begin(&b->plan, &b->directions, &b->relief, &b->load->texture, error);
}

static void release_beginning(void *data)
{
    beginning *b = data;
    weft_direction_map_free(&b->directions);
    weft_relief_map_free(&b->relief);
    free(b);
}

static weft_code run_row(void *data, weft_error *error)
{
    const row *r = data;
    return weft_raw_texture_put(&r->load->texture, &r->strip, error);
}

static void release_row(void *data)
{
    row *r = data;
    free(r->strip.texels);
    free(r);
}

static weft_code run_end(void *data, weft_error *error)
{
    (void)error;
    weft_dataset_load *load = data;
    load->texture.opaque = true;
    return WEFT_OK;
}

static void release_end(void *data)
{
    (void)data;
}

/* ---- The sink of the stream ---- */

static weft_code begin(void *context, const weft_raw_plan *plan, weft_direction_map *directions,
                       weft_relief_map *relief, weft_error *error)
{
    weft_dataset_load *load = context;
    beginning *b = malloc(sizeof *b);
    if (!b)
        return weft_fail_memory(error, "load", sizeof *b);
    *b = (beginning){load, *plan, *directions, *relief};
    *directions = (weft_direction_map){0};
    *relief = (weft_relief_map){0};
    return weft_load_post(load->background, (weft_load_piece){run_beginning, release_beginning, b, 0}, error);
}

static weft_code put(void *context, const weft_raw_strip *strip, weft_error *error)
{
    weft_dataset_load *load = context;
    row *r = malloc(sizeof *r);
    if (!r) {
        free(strip->texels);
        return weft_fail_memory(error, "load", sizeof *r);
    }
    *r = (row){load, *strip};
    return weft_load_post(load->background, (weft_load_piece){run_row, release_row, r, strip->bytes}, error);
}

static weft_code end(void *context, bool opaque, weft_error *error)
{
    weft_dataset_load *load = context;
    if (!opaque)
        return WEFT_OK;
    return weft_load_post(load->background, (weft_load_piece){run_end, release_end, load, 0}, error);
}

weft_code weft_dataset_load_read(weft_dataset_load *load, weft_dataset *dataset, weft_load *background,
                                 weft_error *error)
{
    const weft_raw_sink sink = {load, begin, put, end};
    const weft_progress progress = weft_load_progress(background);
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    load->background = background;
    load->last_ring_z[0] = weft_player_last_ring_z(layout->view, layout->view_count);
    load->last_ring_z[1] = weft_player_last_ring_z(layout->light, layout->image_count);
    return weft_raw_stream(dataset, &load->limits, &progress, &sink, error);
}

void weft_dataset_load_show(weft_dataset_load *load, weft_raw_plan *plan)
{
    *plan = load->texture.plan;
    weft_player_take_raw(load->player, &load->texture, load->last_ring_z);
}
