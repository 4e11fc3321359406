#include "capture/preflight/measure.h"

#include "base/picture/colour.h"

#include <math.h>

enum { TILE = 320, GAP = 4, COLUMNS = 3 };

static int step_of(const weft_session *session)
{
    return (session->camera.width + TILE - 1) / TILE;
}

weft_code weft_sheet_create(const weft_session *session, int poses, weft_image *sheet, weft_error *error)
{
    int step = step_of(session), width = session->camera.width / step, height = session->camera.height / step;
    return weft_image_create(COLUMNS * (width + GAP) - GAP, poses * (height + GAP) - GAP, sheet, error);
}

/* Mean of a square of pixels in a channel, above black, of full scale. */
static double mean_of(const weft_session *session, const uint16_t *samples, int x, int y, int step, int channel)
{
    double sum = 0;
    for (int i = 0; i < step * step; i++) {
        size_t at = (size_t)(y * step + i / step) * (size_t)session->camera.width + (size_t)(x * step + i % step);
        sum += samples[3 * at + (size_t)channel] - session->black_level;
    }
    return sum / (step * step) / ((1 << session->bits) - 1 - session->black_level);
}

/* What column `column` shows of a place. */
static float shade(const weft_session *session, const weft_preflight_photographs *p, int column, int x, int y, int step,
                   int channel)
{
    double first = mean_of(session, p->first, x, y, step, channel);
    if (column == 0)
        return weft_srgb_of_linear((float)fmin(fmax(first, 0), 1));
    if (column == 1)
        return (float)fmin(fmax(0.5 + 8 * (mean_of(session, p->second, x, y, step, channel) - first), 0), 1);
    return weft_srgb_of_linear((float)fmin(fmax(100 * mean_of(session, p->unlit, x, y, step, channel), 0), 1));
}

void weft_sheet_put(const weft_session *session, int row, const weft_preflight_photographs *photographs,
                    weft_image *sheet)
{
    int step = step_of(session), width = session->camera.width / step, height = session->camera.height / step;
    for (int column = 0; column < COLUMNS; column++) {
        for (int y = 0; y < height; y++) {
            for (int x = 0; x < width; x++) {
                size_t at =
                    (size_t)(row * (height + GAP) + y) * (size_t)sheet->width + (size_t)(column * (width + GAP) + x);
                for (int c = 0; c < 3; c++)
                    sheet->pixels[3 * at + (size_t)c] = shade(session, photographs, column, x, y, step, c);
            }
        }
    }
}
