#include "player/legend.h"

#include <stdio.h>

enum { STEPS = 101 };

#define FULL WEFT_SCENE_FULL_DIFFERENCE

static const weft_label_ink darker = {{0, 0, 0, 1}, {-FULL, -FULL, -FULL, 1}};
static const weft_label_ink brighter = {{0, 0, 0, 1}, {FULL, FULL, FULL, 1}};

/* y from the lower edge. */
static void draw_bar(int left, int y, int width, int height)
{
    glEnable(GL_SCISSOR_TEST);
    for (int i = 0; i < STEPS; i++) {
        int from = left + width * i / STEPS, to = left + width * (i + 1) / STEPS;
        float value = FULL * (2 * (float)i / (STEPS - 1) - 1);
        glScissor(from, y, to - from, height);
        glClearColor(value, value, value, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
}

weft_code weft_legend_draw(weft_labels *labels, int width, int height, weft_mode second, weft_error *error)
{
    int size = weft_label_size(height), bar = 8 * size, line = 3 * size / 2, top = height - line - size / 2;
    char below[64], above[64];
    if (width < 36 * size || height < 6 * size)
        return WEFT_OK;
    snprintf(below, sizeof below, "%s darker by %.2f", weft_mode_name(second), (double)FULL);
    snprintf(above, sizeof above, "brighter by %.2f", (double)FULL);
    int left = (width - bar) / 2 + size;
    draw_bar(left, height - top - line, bar, line);
    WEFT_TRY(weft_label_draw(labels, width, height, left, top, true, below, &darker, error));
    return weft_label_draw(labels, width, height, left + bar, top, false, above, &brighter, error);
}
