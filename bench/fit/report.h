/* Tables of results, printed as aligned text, as Markdown for docs/notes/benchmarks.md, or kept as JSON. */
#ifndef WEFT_BENCH_FIT_REPORT_H
#define WEFT_BENCH_FIT_REPORT_H

#include <stdbool.h>

typedef enum report_form { REPORT_TEXT, REPORT_MARKDOWN, REPORT_JSON } report_form;

typedef struct report report;

/* NULL where memory is short. JSON is printed by report_finish, the others table by table. */
report *report_create(report_form form);

/* Begins a table, or goes on with the last one where that has the same heading. `name` is its key in JSON. */
void report_table(report *to, const char *name, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Begins a row of the last table. */
void report_row(report *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A cell of the last row; tables have the same columns in all rows. `digits` after the decimal point are printed. NaN
 * is a cell without a value. */
void report_number(report *to, const char *column, int digits, double value);

/* A line of text below the last table, and in JSON among its "notes". */
void report_note(report *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints what is left and frees. Returns false where memory was short or standard output failed. */
bool report_finish(report *to);

#endif
