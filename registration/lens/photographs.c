#include "registration/lens/fit.h"

#include "base/numeric/statistics.h"
#include "base/picture/image.h"
#include "registration/lens/board.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

enum { LEVELS = 4096 };

/* How much wider than in most photographs edges are where one is blurred, and at least, pixels. */
static const double blurred_ratio = 2, blurred_width = 5;

void weft_board_leave_out(weft_board_photograph *photograph, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(photograph->left_out, sizeof photograph->left_out, format, arguments);
    va_end(arguments);
}

bool weft_board_is_used(const weft_board_photograph *photograph)
{
    return !photograph->left_out[0];
}

int weft_board_used(const weft_board_photograph *photograph, int count)
{
    int used = 0;
    for (int i = 0; i < count; i++)
        used += weft_board_is_used(&photograph[i]);
    return used;
}

/* ---- Grey ---- */

static double luminance(const float *p)
{
    return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
}

/* The level that 995 of 1000 pixels stay below, of at most 1. */
static double bright_level(const weft_image *image)
{
    long histogram[LEVELS] = {0}, pixels = (long)image->width * image->height, above = pixels / 200;
    for (long i = 0; i < pixels; i++) {
        double value = luminance(image->pixels + 3 * i) * (LEVELS - 1);
        histogram[value > 0 ? (int)fmin(value, LEVELS - 1) : 0]++;
    }
    int level = LEVELS - 1;
    for (; level > 1 && above >= histogram[level]; level--)
        above -= histogram[level];
    return (level + 1.0) / LEVELS;
}

/* A photograph that uses the lower part of its range only, as raw values do, is made brighter. Others keep their
 * values: corners are found in the numbers of the file. */
static uint8_t *grey_of(const weft_image *image)
{
    long pixels = (long)image->width * image->height;
    uint8_t *grey = malloc((size_t)pixels);
    double white = bright_level(image), gain = 255 / (white < 0.4 ? white : 1);
    for (long i = 0; grey && i < pixels; i++) {
        double value = gain * luminance(image->pixels + 3 * i);
        grey[i] = (uint8_t)(value > 0 ? fmin(value + 0.5, 255) : 0);
    }
    return grey;
}

/* ---- How blurred a photograph is ---- */

enum { REACH = 10, DIRECTIONS = 4 };

static const int direction[DIRECTIONS][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}};

static int grey_range(const uint8_t *grey, int width, int x0, int y0)
{
    int low = 255, high = 0;
    for (int y = y0 - REACH; y <= y0 + REACH; y++) {
        for (int x = x0 - REACH; x <= x0 + REACH; x++) {
            int value = grey[(long)y * width + x];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
    }
    return high - low;
}

/* Grey values a pixel. */
static double steepest_slope(const uint8_t *grey, int width, int x0, int y0, const int d[2])
{
    int most = 0;
    long step = (long)d[1] * width + d[0];
    for (int y = y0 - REACH; y <= y0 + REACH; y++) {
        for (int x = x0 - REACH; x <= x0 + REACH; x++) {
            const uint8_t *at = grey + (long)y * width + x;
            int difference = abs(at[step] - at[-step]);
            most = difference > most ? difference : most;
        }
    }
    return most / (2 * hypot(d[0], d[1]));
}

/* 0 too near the border, or where there is no edge. */
static double width_at(const uint8_t *grey, int width, int height, const double pixel[2])
{
    int x = (int)lround(pixel[0]), y = (int)lround(pixel[1]);
    if (x <= REACH || y <= REACH || x >= width - REACH - 1 || y >= height - REACH - 1)
        return 0;
    double least = INFINITY;
    for (int i = 0; i < DIRECTIONS; i++)
        least = fmin(least, steepest_slope(grey, width, x, y, direction[i]));
    return least > 0 ? grey_range(grey, width, x, y) / least : 0;
}

/* How wide the edges around the points are, in pixels: grey range over steepest slope, in the direction in which it is
 * least (a shake blurs one direction only); the median of the points. 0 without points. */
static double edge_width(const uint8_t *grey, int width, int height, const weft_board_point *point, int count)
{
    enum { MOST = 256 };
    double widths[MOST];
    int known = 0, stride = count / MOST + 1;
    for (int i = 0; i < count && known < MOST; i += stride) {
        widths[known] = width_at(grey, width, height, point[i].pixel);
        known += widths[known] > 0;
    }
    return weft_quantile(widths, (size_t)known, 0.5);
}

/* ---- One photograph ---- */

static weft_code find_board(const weft_board *board, const weft_image *image, weft_board_photograph *p,
                            weft_error *error)
{
    size_t limit = (size_t)weft_board_point_limit(board);
    uint8_t *grey = grey_of(image);
    p->point = calloc(limit, sizeof *p->point);
    p->stray = calloc(limit, sizeof *p->stray);
    if (!grey || !p->point || !p->stray) {
        free(grey);
        return weft_fail_memory(error, p->name, limit * sizeof *p->point);
    }
    weft_code code = weft_board_find(board, grey, image->width, image->height, p->point, &p->count, error);
    if (code == WEFT_OK)
        p->edge_width = edge_width(grey, image->width, image->height, p->point, p->count);
    free(grey);
    return code;
}

static weft_code read_photograph(const weft_board *board, weft_board_photograph *p, weft_error *error)
{
    weft_image image;
    weft_code code = weft_image_read(p->name, &image, NULL, error);
    if (weft_class_of(code) == WEFT_BAD_INPUT && error) {
        weft_board_leave_out(p, "it cannot be read: %.150s", error->message);
        return WEFT_OK;
    }
    WEFT_TRY(code);
    p->width = image.width;
    p->height = image.height;
    code = find_board(board, &image, p, error);
    weft_image_free(&image);
    int least = weft_board_point_limit(board) < 8 ? 4 : 8;
    if (code == WEFT_OK && p->count == 0)
        weft_board_leave_out(p, "no board was found in it: it is missing, partly hidden, or blurred");
    else if (code == WEFT_OK && p->count < least)
        weft_board_leave_out(p, "only %d corners of the board are seen, not %d", p->count, least);
    return code;
}

/* ---- All of them ---- */

/* The size that most of the used ones have. */
static const weft_board_photograph *find_usual_size(const weft_board_photograph *photograph, int count)
{
    const weft_board_photograph *usual = NULL;
    int most = 0;
    for (int i = 0; i < count; i++) {
        int same = 0;
        for (int k = 0; k < count; k++)
            same += weft_board_is_used(&photograph[k]) && photograph[k].width == photograph[i].width &&
                    photograph[k].height == photograph[i].height;
        if (weft_board_is_used(&photograph[i]) && same > most) {
            most = same;
            usual = &photograph[i];
        }
    }
    return usual;
}

static void leave_out_other_sizes(weft_board_photograph *photograph, int count)
{
    const weft_board_photograph *usual = find_usual_size(photograph, count);
    for (int i = 0; usual && i < count; i++) {
        weft_board_photograph *p = &photograph[i];
        if (weft_board_is_used(p) && (p->width != usual->width || p->height != usual->height))
            weft_board_leave_out(p, "it has %d x %d pixels, others %d x %d", p->width, p->height, usual->width,
                                 usual->height);
    }
}

static weft_code leave_out_blurred(weft_board_photograph *photograph, int count, weft_error *error)
{
    double *width = malloc((size_t)count * sizeof *width);
    int known = 0;
    if (!width)
        return weft_fail_memory(error, "photographs", (size_t)count * sizeof *width);
    for (int i = 0; i < count; i++)
        if (weft_board_is_used(&photograph[i]))
            width[known++] = photograph[i].edge_width;
    double usual = weft_quantile(width, (size_t)known, 0.5);
    for (int i = 0; i < count; i++) {
        weft_board_photograph *p = &photograph[i];
        if (weft_board_is_used(p) && p->edge_width > blurred_width && p->edge_width > blurred_ratio * usual)
            weft_board_leave_out(p, "it is blurred: its edges are %.1f pixels wide, %.1f in others", p->edge_width,
                                 usual);
    }
    free(width);
    return WEFT_OK;
}

static weft_code read_all(const weft_board *board, const weft_lines *names, const weft_progress *progress,
                          weft_board_photograph *photograph, weft_error *error)
{
    for (int i = 0; i < names->count; i++) {
        weft_progress_report(progress, "finding boards", i, names->count);
        photograph[i].name = names->line[i];
        WEFT_TRY(read_photograph(board, &photograph[i], error));
    }
    weft_progress_report(progress, "finding boards", names->count, names->count);
    leave_out_other_sizes(photograph, names->count);
    return leave_out_blurred(photograph, names->count, error);
}

weft_code weft_board_photographs_read(const weft_board *board, const weft_lines *names, const weft_progress *progress,
                                      weft_board_photograph **photograph, weft_error *error)
{
    weft_error cause = {0};
    *photograph = calloc((size_t)names->count + 1, sizeof **photograph);
    if (!*photograph)
        return weft_fail_memory(error, "photographs", (size_t)names->count * sizeof **photograph);
    weft_code code = read_all(board, names, progress, *photograph, &cause);
    if (code != WEFT_OK) {
        weft_board_photographs_free(*photograph, names->count);
        *photograph = NULL;
        return weft_fail(error, code, "%s", cause.message);
    }
    return WEFT_OK;
}

void weft_board_photographs_free(weft_board_photograph *photograph, int count)
{
    for (int i = 0; photograph && i < count; i++) {
        free(photograph[i].point);
        free(photograph[i].stray);
    }
    free(photograph);
}
