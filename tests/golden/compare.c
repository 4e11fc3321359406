#include "tests/golden/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A number and what follows it; false where there is none. */
static bool number_at(const char *text, double *number, const char **end)
{
    char *after;
    *number = strtod(text, &after);
    *end = after;
    return after > text;
}

static bool same_word(const char *expected, const char *actual)
{
    double low, high, found;
    const char *end, *found_end;
    if (!number_at(expected, &low, &end) || !number_at(actual, &found, &found_end) || *found_end)
        return strcmp(expected, actual) == 0;
    if (strncmp(end, "..", 2) == 0 && number_at(end + 2, &high, &end) && !*end)
        return low <= found && found <= high;
    return !*end && (low == found || fabs(found - low) <= fmax(1e-6 * fabs(low), 1e-9));
}

/* Both lines are cut up. */
static bool same_line(char *expected, char *actual)
{
    static const char separators[] = " ,:\n";
    char *rest_expected, *rest_actual;
    char *e = strtok_r(expected, separators, &rest_expected), *a = strtok_r(actual, separators, &rest_actual);
    while (e && a && same_word(e, a)) {
        e = strtok_r(NULL, separators, &rest_expected);
        a = strtok_r(NULL, separators, &rest_actual);
    }
    return !e && !a;
}

static bool read_line(FILE *file, char **line, char **copy)
{
    size_t size = 0;
    *line = *copy = NULL;
    if (getline(line, &size, file) >= 0)
        *copy = strdup(*line);
    return *copy != NULL;
}

/* What materials of version 1 said of the way in which they were stored: it is expanded when they are read. */
static bool is_of_storage(const char *line)
{
    return strncmp(line, "models:", 7) == 0 || strncmp(line, "  model:", 8) == 0;
}

static bool read_expected_line(FILE *file, char **line, char **copy)
{
    bool has_line = read_line(file, line, copy);
    while (has_line && is_of_storage(*line)) {
        free(*line);
        free(*copy);
        has_line = read_line(file, line, copy);
    }
    return has_line;
}

/* Compares the next lines; *more tells whether there were any. */
static bool compare_lines(FILE *expected, FILE *actual, bool *more)
{
    char *line[2], *copy[2];
    bool has_expected = read_expected_line(expected, &line[0], &copy[0]),
         has_actual = read_line(actual, &line[1], &copy[1]);
    bool same = has_expected == has_actual && (!has_expected || same_line(copy[0], copy[1]));
    *more = has_expected && has_actual;
    if (!same)
        fprintf(stderr, "expected: %sfound:    %s", has_expected ? line[0] : "the end\n",
                has_actual ? line[1] : "the end\n");
    for (int i = 0; i < 2; i++) {
        free(line[i]);
        free(copy[i]);
    }
    return same;
}

bool golden_compare(const char *path, FILE *actual)
{
    FILE *expected = fopen(path, "r");
    bool same = expected != NULL;
    int line = 0;
    for (bool more = true; same && more; line++)
        same = compare_lines(expected, actual, &more);
    if (!same)
        fprintf(stderr, "%s:%d: is not what is found now\n", path, line);
    if (expected)
        fclose(expected);
    return same;
}
