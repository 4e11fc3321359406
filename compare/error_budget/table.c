/* The stacks as JSON and as comma-separated values. */
#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "compare/error_budget/error_budget.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- JSON ---- */

static json_t *json_of_share(const weft_source_share *share)
{
    return json_pack("{s:f, s:f, s:f}", "value", share->value, "low", share->low, "high", share->high);
}

static json_t *json_of_part(const weft_error_stack *stack, int part)
{
    json_t *object = json_of_share(&stack->part[part]);
    weft_json_put(&object, "changed", json_real(stack->own[part]));
    return object;
}

json_t *weft_error_budget_to_json(const weft_error_budget *budget)
{
    const weft_error_stack *stack = &budget->stack;
    json_t *object =
        json_pack("{s:o, s:f, s:i, s:i, s:i, s:i, s:f, s:I, s:i, s:f, s:f}", "cloth",
                  weft_json_text(budget->name, strlen(budget->name)), "opening_mm", budget->opening_mm, "size",
                  budget->size, "photographs", budget->photograph_count, "registered", budget->registered_count,
                  "components", budget->component_count, "outermost_deg", weft_deg_of_rad(budget->span.theta_rad),
                  "queries", (json_int_t)stack->query_count, "queries_unseen", budget->span.unseen, "relative_rmse",
                  sqrt(fmax(stack->whole.value, 0)), "noise_of_truth", stack->noise);
    weft_json_put(&object, "squared_relative_error", json_of_share(&stack->whole));
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        weft_json_put(&object, weft_error_source_name((weft_error_source)part), json_of_part(stack, part));
    return object;
}

/* ---- CSV ---- */

/* No cell may hold a comma. */
static void print_name(const char *text, FILE *table)
{
    for (; *text; text++)
        fputc(*text == ',' ? ';' : *text, table);
}

static void print_row(const weft_error_budget *budget, const char *source, const weft_source_share *share,
                      double changed, FILE *table)
{
    print_name(budget->name, table);
    fprintf(table, ",%s,%.6g,%.6g,%.6g,%.6g,%zu,%.4g\n", source, share->value, share->low, share->high, changed,
            budget->stack.query_count, budget->stack.noise);
}

static void print_rows(const weft_error_budget *budget, FILE *table)
{
    const weft_error_stack *stack = &budget->stack;
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        print_row(budget, weft_error_source_name((weft_error_source)part), &stack->part[part], stack->own[part], table);
    print_row(budget, "whole", &stack->whole, stack->whole.value, table);
}

weft_code weft_error_budget_write_csv(const weft_error_budget *budget, int count, const char *path, weft_error *error)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *table = open_memstream(&bytes, &size);
    if (!table)
        return weft_fail_memory(error, "table", 0);
    fputs("cloth,source,squared_relative_error,low,high,changed,queries,noise_of_truth\n", table);
    for (int i = 0; i < count; i++)
        print_rows(&budget[i], table);
    weft_code code =
        fclose(table) == 0 ? weft_write_file(path, bytes, size, error) : weft_fail_memory(error, "table", size);
    free(bytes);
    return code;
}
