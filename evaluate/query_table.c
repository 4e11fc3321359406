#include "evaluate/model.h"

#include <math.h>
#include <string.h>

enum { LX, LY, LZ, VX, VY, VZ, U, V, LEVEL, QUANTITY_COUNT };

static weft_code find_columns(const weft_csv *table, int column[QUANTITY_COUNT], weft_error *error)
{
    static const char *const name[QUANTITY_COUNT] = {"lx", "ly", "lz", "vx", "vy", "vz", "u", "v", "level"};
    for (int i = 0; i < QUANTITY_COUNT; i++) {
        column[i] = weft_csv_column(table, name[i]);
        if (column[i] < 0 && i <= VZ)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' has no column '%s' (needed: lx, ly, lz, vx, vy, vz)",
                             table->path, name[i]);
    }
    if ((column[U] < 0) != (column[V] < 0))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has only one of the columns u and v", table->path);
    return WEFT_OK;
}

static weft_code read_query(const weft_csv *table, int row, const int column[QUANTITY_COUNT], weft_query *query,
                            weft_error *error)
{
    double value[QUANTITY_COUNT] = {0};
    for (int i = 0; i < QUANTITY_COUNT; i++) {
        if (column[i] >= 0)
            WEFT_TRY(weft_csv_number(table, row, column[i], &value[i], error));
    }
    *query = (weft_query){.light = weft_unit(weft_vec3_of(value[LX], value[LY], value[LZ])),
                          .view = weft_unit(weft_vec3_of(value[VX], value[VY], value[VZ])),
                          .has_place = column[U] >= 0,
                          .u = value[U],
                          .v = value[V],
                          .level = value[LEVEL]};
    if (!(weft_dot(query->light, query->light) > 0.5 && weft_dot(query->view, query->view) > 0.5))
        return weft_fail(error, WEFT_BAD_INPUT, "%s:%d: a direction has no length", table->path, table->line[row]);
    return WEFT_OK;
}

static void write_row(const weft_csv *table, int row, const weft_rgb *brdf, FILE *output)
{
    for (int i = 0; i < table->column_count; i++)
        fprintf(output, "%s,", weft_csv_text(table, row, i));
    fprintf(output, "%.9g,%.9g,%.9g", brdf->r, brdf->g, brdf->b);
}

static void write_interval(double value, double half_width, FILE *output)
{
    fprintf(output, ",%.9g,%.9g", fmax(0, value - half_width), value + half_width);
}

static void write_intervals(const weft_model *model, const weft_query *query, const weft_rgb *brdf, FILE *output)
{
    weft_rgb half = weft_model_half_width(model, query, brdf);
    write_interval((double)brdf->r, (double)half.r, output);
    write_interval((double)brdf->g, (double)half.g, output);
    write_interval((double)brdf->b, (double)half.b, output);
}

static weft_code evaluate_row(weft_model *model, const weft_csv *table, int row, const int column[QUANTITY_COUNT],
                              FILE *output, weft_error *error)
{
    weft_query query;
    weft_rgb brdf;
    WEFT_TRY(read_query(table, row, column, &query, error));
    weft_error cause = {0};
    weft_code code = weft_model_brdf(model, &query, &brdf, &cause);
    if (code != WEFT_OK)
        return weft_fail(error, code, "%s:%d: %s", table->path, table->line[row], cause.message);
    write_row(table, row, &brdf, output);
    if (weft_model_has_interval(model))
        write_intervals(model, &query, &brdf, output);
    fputc('\n', output);
    return WEFT_OK;
}

weft_code weft_model_evaluate_table(weft_model *model, const weft_csv *table, const weft_progress *progress,
                                    FILE *output, weft_error *error)
{
    int column[QUANTITY_COUNT];
    WEFT_TRY(find_columns(table, column, error));
    if (weft_model_has_interval(model) && column[U] < 0)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s' has no columns u and v: intervals are of places, not of means",
                         table->path);
    for (int i = 0; i < table->column_count; i++)
        fprintf(output, "%s,", table->column[i]);
    fputs(weft_model_has_interval(model) ? "r,g,b,r_low,r_high,g_low,g_high,b_low,b_high\n" : "r,g,b\n", output);
    for (int row = 0; row < table->row_count; row++) {
        WEFT_TRY(evaluate_row(model, table, row, column, output, error));
        weft_progress_report(progress, "evaluating", row + 1, table->row_count);
    }
    if (fflush(output) != 0 || ferror(output))
        return weft_fail_errno(error, "write", "the evaluated table");
    return WEFT_OK;
}
