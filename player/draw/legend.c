#include "player/draw/player_parts.h"

#include <stdio.h>

enum { STEPS = 101 };

#define FULL WEFT_SCENE_FULL_DIFFERENCE

static const weft_label_ink darker = {{0, 0, 0, 1}, {-FULL, -FULL, -FULL, 1}};
static const weft_label_ink brighter = {{0, 0, 0, 1}, {FULL, FULL, FULL, 1}};

/* Brighter above; x, y: of its lower left corner, from that of the picture. */
static void draw_bar(int x, int y, int width, int height)
{
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < STEPS; i++) {
        int from = height * i / STEPS, to = height * (i + 1) / STEPS;
        float value = FULL * (2 * (float)i / (STEPS - 1) - 1);
        glScissor(x, y + from, width, to - from);
        glClearColor(value, value, value, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
}

weft_code weft_legend_draw(weft_labels *labels, int width, int height, weft_mode second, weft_error *error)
{
    int size = weft_label_size(height), margin = size, line = 3 * size / 2, bar = 5 * size, right = margin + line;
    char above[64], below[64];
    if (width < 20 * size || height < 8 * size)
        return WEFT_OK;
    snprintf(above, sizeof above, "%s brighter by %.2f", weft_mode_name(second), (double)FULL);
    snprintf(below, sizeof below, "darker by %.2f", (double)FULL);
    draw_bar(margin, margin, line, bar);
    WEFT_TRY(weft_label_draw(labels, width, height, right, height - margin - bar, false, above, &brighter, error));
    return weft_label_draw(labels, width, height, right, height - margin - line, false, below, &darker, error);
}
