/* Tables of comma-separated values: light and view positions, directions to evaluate, lists of photographs.
 * No quoting: a cell holds neither a comma nor a line break. Blank lines and lines that begin with # are skipped. */
#ifndef WEFT_BASE_TEXT_CSV_H
#define WEFT_BASE_TEXT_CSV_H

#include "base/status.h"

#include <stdbool.h>

/* Owned by the caller, freed with weft_csv_free. Cells and names are trimmed of white space. */
typedef struct weft_csv {
    char *path; /* for messages */
    char *text; /* what the cells point into */
    int column_count, row_count;
    char **column; /* [column_count] names; NULL without a header */
    char **cell;   /* [row_count][column_count] */
    int *line;     /* [row_count] line of the file, from 1 */
} weft_csv;

/* Reads a file of at most 1 GiB and 4096 columns. Errors: WEFT_BAD_INPUT where it is missing, has no line, where a line
 * has another number of cells than the first, or where two columns have one name. */
weft_code weft_csv_read(const char *path, bool has_header, weft_csv *csv, weft_error *error);
void weft_csv_free(weft_csv *csv);

/* Index of a column, or -1. Pure. */
int weft_csv_column(const weft_csv *csv, const char *name);

/* The text of a cell. Pure. */
const char *weft_csv_text(const weft_csv *csv, int row, int column);

/* The finite number in a cell. Errors: WEFT_BAD_INPUT "PATH:LINE: ...". */
weft_code weft_csv_number(const weft_csv *csv, int row, int column, double *value, weft_error *error);

#endif
