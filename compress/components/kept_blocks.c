#include "compress/components/kept_blocks.h"

#include "compress/run/record.h"

#include <stdio.h>
#include <stdlib.h>

/* What was counted belongs to all blocks so far. */
static void transfer_block(weft_projection *projection, const weft_block_place *place, weft_record *record)
{
    size_t columns = (size_t)place->width, components = (size_t)projection->component_count;
    for (int y = place->y; y < place->y + place->height; y++) {
        size_t first = (size_t)y * (size_t)projection->width + (size_t)place->x;
        weft_record_transfer(record, projection->coefficient + first * components,
                             columns * components * sizeof(float));
        weft_record_transfer(record, projection->brightest + first, columns * sizeof(float));
        weft_record_transfer(record, projection->floor + 3 * first, 3 * columns * sizeof(float));
    }
    weft_record_transfer(record, &projection->masked, sizeof projection->masked);
    weft_record_transfer(record, &projection->empty, sizeof projection->empty);
}

static weft_code take_block(weft_checkpoint *checkpoint, const weft_block_place *place, weft_projection *projection,
                            weft_error *error)
{
    weft_record record = {0};
    weft_code code = weft_checkpoint_read(checkpoint, &record, error);
    if (code == WEFT_OK) {
        transfer_block(projection, place, &record);
        if (record.failed || record.at != record.size)
            code =
                weft_fail(error, WEFT_BAD_INPUT, "'%s': a record of components does not fit its block; remove the file",
                          weft_checkpoint_path(checkpoint));
    }
    free(record.bytes);
    return code;
}

weft_code weft_kept_blocks_take(weft_checkpoint *checkpoint, const weft_log *log, const weft_block_plan *plan,
                                weft_projection *projection, size_t *count, weft_error *error)
{
    *count = 0;
    if (!checkpoint)
        return WEFT_OK;
    for (; *count < plan->count && weft_checkpoint_unread(checkpoint) > 0; (*count)++)
        WEFT_TRY(take_block(checkpoint, &plan->place[*count], projection, error));
    if (*count > 0) {
        char text[WEFT_MESSAGE_SIZE];
        snprintf(text, sizeof text, "going on after %zu of %zu blocks of components, kept in %s", *count, plan->count,
                 weft_checkpoint_path(checkpoint));
        weft_log_line(log, text);
    }
    return WEFT_OK;
}

weft_code weft_kept_blocks_add(weft_checkpoint *checkpoint, weft_projection *projection, const weft_block_place *place,
                               weft_error *error)
{
    if (!checkpoint)
        return WEFT_OK;
    weft_record record = {0};
    transfer_block(projection, place, &record);
    weft_code code = record.failed ? weft_fail_memory(error, "record of a block", record.size)
                                   : weft_checkpoint_append(checkpoint, &record, error);
    free(record.bytes);
    return code;
}
