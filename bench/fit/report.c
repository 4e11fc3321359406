#include "bench/fit/report.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_COLUMNS = 16, NAME_WIDTH = 36, MIN_WIDTH = 9 };

struct report {
    report_form form;
    bool failed;
    json_t *tables, *table, *row; /* the last two are borrowed */
    int digits[MAX_COLUMNS];      /* of the last table */
};

report *report_create(report_form form)
{
    report *created = calloc(1, sizeof *created);
    if (created) {
        created->form = form;
        created->tables = json_array();
    }
    return created;
}

static int column_width(const char *name)
{
    int length = (int)strlen(name);
    return length > MIN_WIDTH ? length : MIN_WIDTH;
}

static void print_name(const report *from, const char *name)
{
    if (from->form == REPORT_MARKDOWN)
        printf("| %s |", name);
    else
        printf("%-*s", NAME_WIDTH, name);
}

static void print_cell(const report *from, const char *column, const char *text)
{
    if (from->form == REPORT_MARKDOWN)
        printf(" %s |", text);
    else
        printf("  %*s", column_width(column), text);
}

static void print_header(const report *from, json_t *row)
{
    const char *name;
    json_t *cell;
    print_name(from, "");
    json_object_foreach (row, name, cell) {
        if (strcmp(name, "name") != 0)
            print_cell(from, name, name);
    }
    printf("\n");
    for (size_t i = 0; from->form == REPORT_MARKDOWN && i < json_object_size(row); i++)
        printf(i + 1 < json_object_size(row) ? "| --- " : "| --- |\n");
}

static void print_row(const report *from, json_t *row)
{
    const char *name;
    json_t *cell;
    int column = 0;
    print_name(from, json_string_value(json_object_get(row, "name")));
    json_object_foreach (row, name, cell) {
        char text[64] = "-";
        if (!strcmp(name, "name"))
            continue;
        if (json_is_number(cell))
            snprintf(text, sizeof text, "%.*f", from->digits[column], json_number_value(cell));
        print_cell(from, name, text);
        column++;
    }
    printf("\n");
}

static void print_table(const report *from)
{
    json_t *rows = json_object_get(from->table, "rows"), *element;
    size_t index;
    if (from->form == REPORT_JSON || !from->table)
        return;
    printf("\n%s\n%s", json_string_value(json_object_get(from->table, "title")),
           from->form == REPORT_MARKDOWN ? "\n" : "");
    if (json_array_size(rows))
        print_header(from, json_array_get(rows, 0));
    json_array_foreach (rows, index, element)
        print_row(from, element);
    json_array_foreach (json_object_get(from->table, "notes"), index, element)
        printf("%s\n", json_string_value(element));
    fflush(stdout);
}

void report_table(report *to, const char *name, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    json_t *title = json_vsprintf(format, arguments);
    va_end(arguments);
    if (to->table && json_equal(title, json_object_get(to->table, "title"))) {
        json_decref(title);
        return;
    }
    print_table(to);
    to->table = json_pack("{s:s, s:o, s:[], s:[]}", "name", name, "title", title, "rows", "notes");
    to->failed |= json_array_append_new(to->tables, to->table) != 0;
}

void report_row(report *to, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    to->row = json_pack("{s:o}", "name", json_vsprintf(format, arguments));
    va_end(arguments);
    to->failed |= json_array_append_new(json_object_get(to->table, "rows"), to->row) != 0;
}

void report_number(report *to, const char *column, int digits, double value)
{
    size_t index = json_object_size(to->row) - 1;
    if (index < MAX_COLUMNS)
        to->digits[index] = digits;
    to->failed |= json_object_set_new(to->row, column, isfinite(value) ? json_real(value) : json_null()) != 0;
}

void report_note(report *to, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    json_t *text = json_vsprintf(format, arguments);
    va_end(arguments);
    to->failed |= json_array_append_new(json_object_get(to->table, "notes"), text) != 0;
}

bool report_finish(report *to)
{
    print_table(to);
    json_t *all = json_pack("{s:s, s:O}", "benchmark", "fit", "tables", to->tables);
    if (to->form == REPORT_JSON)
        to->failed |= json_dumpf(all, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) != 0 || putchar('\n') == EOF;
    bool done = all && !to->failed && fflush(stdout) == 0;
    json_decref(all);
    json_decref(to->tables);
    free(to);
    return done;
}
