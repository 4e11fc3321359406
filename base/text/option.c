#include "base/text/option.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Values ---- */

weft_code weft_option_number(const char *name, const char *text, double low, double high, double *number,
                             weft_error *error)
{
    char *end;
    *number = strtod(text, &end);
    if (end == text || *end || !(*number >= low && *number <= high))
        return weft_fail(error, WEFT_BAD_USAGE, "--%s needs a number from %g to %g, not '%s'", name, low, high, text);
    return WEFT_OK;
}

/* strtoull would skip blanks and take a minus sign. */
static bool whole_from(const char *text, unsigned long long *number, char **end)
{
    errno = 0;
    *number = strtoull(text, end, 10);
    return isdigit((unsigned char)*text) && errno == 0;
}

weft_code weft_option_whole(const char *name, const char *text, unsigned long long low, unsigned long long high,
                            unsigned long long *number, weft_error *error)
{
    char *end;
    if (!whole_from(text, number, &end) || *end || *number < low || *number > high)
        return weft_fail(error, WEFT_BAD_USAGE, "--%s needs a whole number from %llu to %llu, not '%s'", name, low,
                         high, text);
    return WEFT_OK;
}

weft_code weft_option_numbers(const char *name, const char *text, int count, double *number, weft_error *error)
{
    const char *at = text;
    for (int i = 0; i < count; i++) {
        char *end;
        number[i] = strtod(at, &end);
        if (end == at || !isfinite(number[i]) || *end != (i + 1 < count ? ',' : '\0'))
            return weft_fail(error, WEFT_BAD_USAGE, "--%s needs %d numbers with commas, not '%s'", name, count, text);
        at = end + 1;
    }
    return WEFT_OK;
}

/* "a or b", or "one of a, b, c". */
static void list_words(const char *const *words, char *list, size_t size)
{
    bool two = words[0] && words[1] && !words[2];
    int used = snprintf(list, size, "%s%s", two ? "" : "one of ", words[0]);
    for (int i = 1; words[i] && used >= 0 && (size_t)used < size; i++)
        used += snprintf(list + used, size - (size_t)used, "%s%s", two ? " or " : ", ", words[i]);
}

weft_code weft_option_word(const char *name, const char *text, const char *const *words, int *index, weft_error *error)
{
    char list[128];
    for (int i = 0; words[i]; i++) {
        if (strcmp(words[i], text) == 0) {
            *index = i;
            return WEFT_OK;
        }
    }
    list_words(words, list, sizeof list);
    return weft_fail(error, WEFT_BAD_USAGE, "--%s is %s, not '%s'", name, list, text);
}

weft_code weft_option_copy(const char *text, char **owned, weft_error *error)
{
    char *copy = text ? strdup(text) : NULL;
    if (text && !copy)
        return weft_fail_memory(error, text, strlen(text));
    free(*owned);
    *owned = copy;
    return WEFT_OK;
}

/* ---- Options ---- */

static weft_code set_switch(const weft_option *option, const char *text, bool *value, weft_error *error)
{
    static const char *const words[] = {"on", "off", NULL};
    int word = 0;
    if (text)
        WEFT_TRY(weft_option_word(option->name, text, words, &word, error));
    *value = word == 0;
    return WEFT_OK;
}

static weft_code set_int(const weft_option *option, const char *text, unsigned long long low, unsigned long long high,
                         int *value, weft_error *error)
{
    unsigned long long number;
    WEFT_TRY(weft_option_whole(option->name, text, low, high, &number, error));
    *value = (int)number;
    return WEFT_OK;
}

static weft_code set_seed(const weft_option *option, const char *text, uint64_t *value, weft_error *error)
{
    unsigned long long number;
    WEFT_TRY(weft_option_whole(option->name, text, 0, INT64_MAX, &number, error));
    *value = number;
    return WEFT_OK;
}

static weft_code set_noise(const weft_option *option, const char *text, int *value, weft_error *error)
{
    if (strcmp(text, "off") != 0)
        return set_int(option, text, 1, INT_MAX, value, error);
    *value = 0;
    return WEFT_OK;
}

static weft_code set_number(const weft_option *option, const char *text, double *value, weft_error *error)
{
    double number;
    WEFT_TRY(weft_option_number(option->name, text, option->low, option->high, &number, error));
    if (option->kind == WEFT_OPTION_ANGLE)
        *value = number * (M_PI / 180);
    else
        *value = option->divisor != 0 ? number / option->divisor : number;
    return WEFT_OK;
}

static weft_code set_size(const weft_option *option, const char *text, int *value, weft_error *error)
{
    unsigned long long width = 0, height = 0, most = (unsigned long long)option->high;
    char *end;
    if (!whole_from(text, &width, &end) || *end != 'x' || !whole_from(end + 1, &height, &end) || *end || width < 1 ||
        height < 1 || width > most || height > most)
        return weft_fail(error, WEFT_BAD_USAGE, "--%s needs WxH up to %llux%llu, not '%s'", option->name, most, most,
                         text);
    value[0] = (int)width;
    value[1] = (int)height;
    return WEFT_OK;
}

static weft_code set_pair(const weft_option *option, const char *text, double *value, weft_error *error)
{
    double pair[2];
    WEFT_TRY(weft_option_numbers(option->name, text, 2, pair, error));
    for (int i = 0; i < 2; i++)
        if (!(pair[i] > 0 && pair[i] <= option->high))
            return weft_fail(error, WEFT_BAD_USAGE, "--%s needs two numbers above 0, up to %g, not '%s'", option->name,
                             option->high, text);
    memcpy(value, pair, sizeof pair);
    return WEFT_OK;
}

weft_code weft_option_set(const weft_option *option, const char *text, void *target, weft_error *error)
{
    void *value = (char *)target + option->offset;
    if (option->read)
        return option->read(option, text, target, error);
    switch (option->kind) {
    case WEFT_OPTION_FLAG:
        *(bool *)value = true;
        return WEFT_OK;
    case WEFT_OPTION_SWITCH:
        return set_switch(option, text, value, error);
    case WEFT_OPTION_WHOLE:
        return set_int(option, text, (unsigned long long)option->low, (unsigned long long)option->high, value, error);
    case WEFT_OPTION_SEED:
        return set_seed(option, text, value, error);
    case WEFT_OPTION_NOISE:
        return set_noise(option, text, value, error);
    case WEFT_OPTION_NUMBER:
    case WEFT_OPTION_ANGLE:
        return set_number(option, text, value, error);
    case WEFT_OPTION_SIZE:
        return set_size(option, text, value, error);
    case WEFT_OPTION_PAIR:
        return set_pair(option, text, value, error);
    case WEFT_OPTION_CHOICE:
        return weft_option_word(option->name, text, option->words, value, error);
    case WEFT_OPTION_NAME:
        return weft_option_copy(text, value, error);
    default:
        *(const char **)value = text;
        return WEFT_OK;
    }
}
