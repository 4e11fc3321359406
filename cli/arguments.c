#include "cli/arguments.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

double parse_number(const char *option, const char *text, double low, double high, struct argp_state *state)
{
    char *end;
    double number = strtod(text, &end);
    if (end == text || *end || !(number >= low && number <= high))
        argp_error(state, "--%s needs a number from %g to %g, not '%s'", option, low, high, text);
    return number;
}

void parse_numbers(const char *option, const char *text, int count, double *numbers, struct argp_state *state)
{
    const char *at = text;
    for (int i = 0; i < count; i++) {
        char *end;
        numbers[i] = strtod(at, &end);
        if (end == at || !isfinite(numbers[i]) || *end != (i + 1 < count ? ',' : '\0'))
            argp_error(state, "--%s needs %d numbers with commas, not '%s'", option, count, text);
        at = end + 1;
    }
}

/* strtoull would skip blanks and take a minus sign. */
static bool whole_from(const char *text, unsigned long long *number, char **end)
{
    errno = 0;
    *number = strtoull(text, end, 10);
    return isdigit((unsigned char)*text) && errno == 0;
}

unsigned long long parse_whole(const char *option, const char *text, unsigned long long low, unsigned long long high,
                               struct argp_state *state)
{
    unsigned long long number;
    char *end;
    if (!whole_from(text, &number, &end) || *end || number < low || number > high)
        argp_error(state, "--%s needs a whole number from %llu to %llu, not '%s'", option, low, high, text);
    return number;
}

void parse_size(const char *option, const char *text, int limit, int *width, int *height, struct argp_state *state)
{
    unsigned long long w = 0, h = 0, most = (unsigned long long)limit;
    char *end;
    if (!whole_from(text, &w, &end) || *end != 'x' || !whole_from(end + 1, &h, &end) || *end || w < 1 || h < 1 ||
        w > most || h > most)
        argp_error(state, "--%s needs WxH up to %dx%d, not '%s'", option, limit, limit, text);
    *width = (int)w;
    *height = (int)h;
}

void parse_tiles(const char *option, const char *text, double *tiles_u, double *tiles_v, struct argp_state *state)
{
    double tiles[2];
    parse_numbers(option, text, 2, tiles, state);
    for (int i = 0; i < 2; i++) {
        if (!(tiles[i] > 0 && tiles[i] <= 1e6))
            argp_error(state, "--%s needs two numbers above 0, up to 1e6, not '%s'", option, text);
    }
    *tiles_u = tiles[0];
    *tiles_v = tiles[1];
}

int parse_noise_seed(const char *option, const char *text, struct argp_state *state)
{
    return strcmp(text, "off") == 0 ? 0 : (int)parse_whole(option, text, 1, INT_MAX, state);
}

bool parse_switch(const char *option, const char *text, struct argp_state *state)
{
    if (strcmp(text, "on") != 0 && strcmp(text, "off") != 0)
        argp_error(state, "--%s is on or off, not '%s'", option, text);
    return strcmp(text, "on") == 0;
}

void refuse_same_file(const char *output, const char *input, struct argp_state *state)
{
    struct stat written, read;
    if (output && input && stat(output, &written) == 0 && stat(input, &read) == 0 && written.st_dev == read.st_dev &&
        written.st_ino == read.st_ino)
        argp_error(state, "'%s' would overwrite what it is made from", output);
}
