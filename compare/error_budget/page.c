/* The page: one stack for each cloth, and the numbers. */
#include "base/text/html_page.h"
#include "compare/error_budget/error_budget.h"

#include <math.h>

/* A name stands above its bar. */
enum { WIDTH = 560, LEFT = 16, RIGHT = 72, TOP = 34, BOTTOM = 40, BAR = 22, PITCH = 56 };

/* ---- The plot ---- */

/* Squared relative errors over pixels. */
typedef struct axis {
    double low, high, step;
} axis;

static double place_on(const axis *x, double value)
{
    return LEFT + (WIDTH - LEFT - RIGHT) * (value - x->low) / (x->high - x->low);
}

/* Parts below 0 go to the left of 0, one behind the other, as those above go to the right. */
static void stack_ends(const weft_error_stack *stack, double *low, double *high)
{
    *low = *high = 0;
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        *(stack->part[part].value < 0 ? low : high) += stack->part[part].value;
}

static axis fit_axis(const weft_error_budget *budget, int count)
{
    axis x = {0, 1e-9, 0};
    for (int i = 0; i < count; i++) {
        double low, high;
        stack_ends(&budget[i].stack, &low, &high);
        x.low = fmin(x.low, low);
        x.high = fmax(fmax(x.high, high), budget[i].stack.whole.high);
    }
    double rough = (x.high - x.low) / 6, power = pow(10, floor(log10(rough)));
    x.step = power * (rough > 5 * power ? 10 : rough > 2 * power ? 5 : rough > power ? 2 : 1);
    x.low = x.step * floor(x.low / x.step);
    x.high = x.step * ceil(x.high / x.step);
    return x;
}

static void draw_grid(weft_page *page, const axis *x, int count)
{
    int bottom = TOP + count * PITCH;
    fputs("<g class=\"grid\">", page->html);
    for (int i = 0; x->low + i * x->step < x->high + x->step / 2; i++) {
        double value = x->low + i * x->step, at = place_on(x, value);
        fprintf(page->html, "<path d=\"M%.1f %dV%d\"/><text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%.3g</text>", at,
                TOP - 6, bottom, at, bottom + 15, fabs(value) < x->step / 2 ? 0 : value);
    }
    fprintf(page->html, "</g><text x=\"%d\" y=\"%d\" text-anchor=\"end\">squared relative error</text>\n", WIDTH - 8,
            bottom + 35);
}

static void draw_key(weft_page *page)
{
    fprintf(page->html, "<text x=\"%d\" y=\"20\">", LEFT);
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        fprintf(page->html, "<tspan class=\"key colour%d\">\u25a0</tspan> %s \u2003", part,
                weft_error_source_name((weft_error_source)part));
    fputs("</text>\n", page->html);
}

static void draw_part(weft_page *page, const axis *x, const weft_error_stack *stack, int part, double from, double y)
{
    const weft_source_share *share = &stack->part[part];
    double left = place_on(x, fmin(from, from + share->value)), right = place_on(x, fmax(from, from + share->value));
    fprintf(page->html,
            "<rect class=\"bar colour%d\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%d\"><title>%s %.3g (%.3g to "
            "%.3g)</title></rect>",
            part, left, y, right - left, BAR, weft_error_source_name((weft_error_source)part), share->value, share->low,
            share->high);
}

/* The whole and its interval, over the stack. */
static void draw_whole(weft_page *page, const axis *x, const weft_error_stack *stack, double y)
{
    double middle = y + BAR / 2.0, at = place_on(x, stack->whole.value), high = place_on(x, stack->whole.high);
    fprintf(page->html, "<path class=\"whole\" d=\"M%.1f %.1fV%.1fM%.1f %.1fH%.1f\"/>", at, y - 3, y + BAR + 3,
            place_on(x, stack->whole.low), middle, high);
    double ends[2];
    stack_ends(stack, &ends[0], &ends[1]);
    fprintf(page->html, "<text class=\"label\" x=\"%.1f\" y=\"%.1f\">%.1f %%</text>\n",
            fmax(high, place_on(x, ends[1])) + 6, middle + 4, 100 * sqrt(fmax(stack->whole.value, 0)));
}

static void draw_stack(weft_page *page, const axis *x, const weft_error_budget *budget, double y)
{
    double low = 0, high = 0;
    fprintf(page->html, "<text x=\"%d\" y=\"%.1f\">", LEFT, y - 7);
    weft_page_text(page, budget->name);
    fputs("</text>", page->html);
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++) {
        double value = budget->stack.part[part].value, *end = value < 0 ? &low : &high;
        draw_part(page, x, &budget->stack, part, *end, y);
        *end += value;
    }
    draw_whole(page, x, &budget->stack, y);
}

static void put_plot(weft_page *page, const weft_error_budget *budget, int count)
{
    axis x = fit_axis(budget, count);
    fprintf(page->html,
            "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"Where the error comes from\">\n",
            WIDTH, TOP + count * PITCH + BOTTOM);
    draw_key(page);
    draw_grid(page, &x, count);
    for (int i = 0; i < count; i++)
        draw_stack(page, &x, &budget[i], TOP + (i + 1) * PITCH - BAR - 6);
    fputs("</svg>\n", page->html);
}

/* ---- Numbers ---- */

static void put_share(weft_page *page, const weft_source_share *share)
{
    fprintf(page->html, "<td title=\"%.3g to %.3g\">%.4f</td>", share->low, share->high, share->value);
}

static void put_row(weft_page *page, const weft_error_budget *s)
{
    const weft_error_stack *stack = &s->stack;
    fputs("<tr><td>", page->html);
    weft_page_text(page, s->name);
    fprintf(page->html, "</td><td><b>%.1f %%</b></td><td>%.1f to %.1f %%</td>", 100 * sqrt(fmax(stack->whole.value, 0)),
            100 * sqrt(fmax(stack->whole.low, 0)), 100 * sqrt(fmax(stack->whole.high, 0)));
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        put_share(page, &stack->part[part]);
    put_share(page, &stack->whole);
    for (int part = 0; part < WEFT_SOURCE_COUNT; part++)
        fprintf(page->html, "<td>%.1f %%</td>", 100 * sqrt(fmax(stack->own[part], 0)));
    fprintf(page->html, "<td>%.1f %%</td><td>%zu</td><td>%d of %d</td><td>%.3g mm</td></tr>\n", 100 * stack->noise,
            stack->query_count, s->registered_count, s->photograph_count, s->opening_mm / s->size);
}

static void put_table(weft_page *page, const weft_error_budget *budget, int count)
{
    fputs("<h2>Numbers</h2>\n<table class=\"long\">\n", page->html);
    weft_page_columns(page, ":cloth|relative RMSE|95 % interval|directions|registration|model|storage|sum|directions "
                            "changed|registration changed|model changed|storage changed|noise of the truth|queries|"
                            "photographs|texel");
    for (int i = 0; i < count; i++)
        put_row(page, &budget[i]);
    fputs("</table>\n", page->html);
    fputs(
        "<p class=\"note\">Parts and their sum are squares. Point at one to see its interval, or open <a "
        "href=\"sources.csv\">sources.csv</a>. <i>Changed</i> is the RMS change by a stage, whether it made the error "
        "larger or smaller. Intervals hold for other queries of the same photographs (bootstrap). The noise of the "
        "truth is its standard error. It is not part of the sum: each part multiplies two independent renderings of "
        "the cloth.</p>\n",
        page->html);
}

static void put_summary(weft_page *page, const weft_error_budget *budget, const weft_error_budget_request *request)
{
    fprintf(
        page->html,
        "<p>The error of a material against the virtual cloth that it was made from, and the part of each stage. "
        "Each cloth was photographed by the virtual rig (%d photographs), registered to %d \u00d7 %d texels, fitted "
        "by %d components and stored. Then %d places, lights and views were drawn at random, evenly in solid angle up "
        "to %.0f\u00b0 from the normal. The number beside a bar is the relative RMSE; the length of the bar is "
        "its square.</p>\n",
        budget->photograph_count, budget->size, budget->size, budget->component_count, request->queries.count,
        weft_deg_of_rad(budget->span.theta_rad));
}

static void put_explanation(weft_page *page)
{
    fputs(
        "<ul>\n<li><b>directions</b>: the exact samples of the cloth in the photographed directions, "
        "interpolated</li>\n<li><b>registration</b>: the registered samples (lens, sensor, lamp, poses), interpolated "
        "the same "
        "way</li>\n<li><b>model</b>: the components that were fitted to these samples, with 15-bit "
        "coefficients</li>\n<li><b>storage</b>: the same components as the file stores them, in 8 bits</li>\n</ul>\n"
        "<p class=\"note\">A part is the squared error after its stage minus the squared error before it. Parts add "
        "up, "
        "but they are not independent: a part is negative, and drawn to the left, where its stage corrects an earlier "
        "error.</p>\n",
        page->html);
}

weft_code weft_error_budget_write_page(const weft_error_budget *budget, int count,
                                       const weft_error_budget_request *request, weft_error *error)
{
    weft_page page;
    WEFT_TRY(weft_page_begin(request->folder, "Where the error comes from", &page, error));
    put_summary(&page, budget, request);
    put_plot(&page, budget, count);
    put_explanation(&page);
    put_table(&page, budget, count);
    return weft_page_finish(&page, error);
}
