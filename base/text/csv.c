#include "base/text/csv.h"

#include "base/atomic_file.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const size_t largest_file = (size_t)1 << 30;

enum { MOST_COLUMNS = 4096 };

static char *trimmed(char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    char *end = text + strlen(text);
    while (end > text && isspace((unsigned char)end[-1]))
        *--end = 0;
    return text;
}

static bool is_skipped(const char *line)
{
    while (isspace((unsigned char)*line))
        line++;
    return !*line || *line == '#';
}

static int count_cells(const char *line)
{
    int count = 1;
    for (; *line; line++)
        count += *line == ',';
    return count;
}

static int count_lines(const char *text)
{
    int count = 1;
    for (; *text; text++)
        count += *text == '\n';
    return count;
}

static void split_cells(char *line, int count, char **cell)
{
    for (int i = 0; i < count; i++)
        cell[i] = trimmed(strsep(&line, ","));
}

/* The first line fixes the number of columns, so the arrays can only be sized once it is seen. */
static weft_code allocate_rows(weft_csv *csv, int lines, weft_error *error)
{
    size_t columns = (size_t)csv->column_count;
    csv->column = calloc(columns, sizeof *csv->column);
    csv->cell = calloc((size_t)lines * columns, sizeof *csv->cell);
    csv->line = calloc((size_t)lines, sizeof *csv->line);
    if (!csv->column || !csv->cell || !csv->line)
        return weft_fail_memory(error, csv->path, (size_t)lines * columns * sizeof *csv->cell);
    return WEFT_OK;
}

/* A reader asks for columns by name: two of one name would leave one of them unread. */
static weft_code check_names(const weft_csv *csv, int number, weft_error *error)
{
    for (int i = 0; i < csv->column_count; i++) {
        if (*csv->column[i] && weft_csv_column(csv, csv->column[i]) < i)
            return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: two columns are named '%s'", csv->path, number,
                             csv->column[i]);
    }
    return WEFT_OK;
}

static weft_code split_lines(weft_csv *csv, bool has_header, weft_error *error)
{
    int lines = count_lines(csv->text), number = 0;
    bool header_pending = has_header;
    for (char *rest = csv->text; rest;) {
        char *line = strsep(&rest, "\n");
        number++;
        if (is_skipped(line))
            continue;
        int cells = count_cells(line);
        if (!csv->cell) {
            if (cells > MOST_COLUMNS)
                return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: %d columns, at most %d are read", csv->path, number,
                                 cells, MOST_COLUMNS);
            csv->column_count = cells;
            WEFT_TRY(allocate_rows(csv, lines, error));
        }
        if (cells != csv->column_count)
            return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: %d cells, but %d in the first line", csv->path, number,
                             cells, csv->column_count);
        if (header_pending) {
            split_cells(line, cells, csv->column);
            WEFT_TRY(check_names(csv, number, error));
            header_pending = false;
            continue;
        }
        csv->line[csv->row_count] = number;
        split_cells(line, cells, csv->cell + (size_t)csv->row_count++ * (size_t)cells);
    }
    if (!csv->cell)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' is empty", csv->path);
    return WEFT_OK;
}

/* Spreadsheets put a mark of the byte order before UTF-8, which has none. */
static void drop_byte_order_mark(char *text)
{
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0)
        memmove(text, text + 3, strlen(text + 3) + 1);
}

weft_code weft_csv_read(const char *path, bool has_header, weft_csv *csv, weft_error *error)
{
    *csv = (weft_csv){0};
    size_t size = 0;
    WEFT_TRY(weft_read_file(path, largest_file, &csv->text, &size, error));
    weft_code code = WEFT_OK;
    csv->path = strdup(path);
    if (!csv->path)
        code = weft_fail_memory(error, "path", strlen(path));
    else if (strlen(csv->text) != size)
        code = weft_fail(error, WEFT_BAD_INPUT, "'%s' is not text", path);
    else {
        drop_byte_order_mark(csv->text);
        code = split_lines(csv, has_header, error);
    }
    if (code != WEFT_OK)
        weft_csv_free(csv);
    return code;
}

void weft_csv_free(weft_csv *csv)
{
    free(csv->path);
    free(csv->text);
    free(csv->column);
    free(csv->cell);
    free(csv->line);
    *csv = (weft_csv){0};
}

int weft_csv_column(const weft_csv *csv, const char *name)
{
    for (int i = 0; i < csv->column_count; i++) {
        if (csv->column[i] && strcmp(csv->column[i], name) == 0)
            return i;
    }
    return -1;
}

const char *weft_csv_text(const weft_csv *csv, int row, int column)
{
    return csv->cell[(size_t)row * (size_t)csv->column_count + (size_t)column];
}

weft_code weft_csv_number(const weft_csv *csv, int row, int column, double *value, weft_error *error)
{
    const char *text = weft_csv_text(csv, row, column);
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end || !isfinite(*value))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: '%s' is not a finite number", csv->path, csv->line[row], text);
    return WEFT_OK;
}
