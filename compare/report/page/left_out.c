#include "compare/report/page/sections.h"

static void print_table(weft_page *page, const weft_leave_one_out *left_out)
{
    fputs("<table>", page->html);
    weft_page_columns(page, "photograph left out|values|relative RMSE|median relative");
    for (int i = 0; i < left_out->count; i++) {
        const weft_left_out *photograph = &left_out->photograph[i];
        fputs("<tr><td>", page->html);
        weft_page_text(page, photograph->name);
        fprintf(page->html, "</td><td>%ld</td><td>%.2f %%</td><td>%.2f %%</td></tr>\n", photograph->error.count,
                100 * photograph->error.relative_rmse, 100 * photograph->error.median_relative);
    }
    fprintf(page->html, "<tr><th scope=\"row\">mean</th><td></td><td>%.2f %%</td><td>%.2f %%</td></tr></table>\n",
            100 * left_out->mean_relative_rmse, 100 * left_out->mean_median_relative);
}

weft_code weft_page_left_out(weft_page *page, const weft_leave_one_out *left_out, weft_error *error)
{
    if (left_out->count == 0)
        return WEFT_OK;
    fprintf(page->html,
            "<h2>Leave one out</h2>\n<p class=\"note\">Each photograph predicted by a fit to the %d others, over its "
            "valid samples and all channels. All fits together took %.1f s.</p>\n",
            left_out->count - 1, left_out->seconds);
    print_table(page, left_out);
    for (int i = 0; i < left_out->count; i++) {
        const weft_left_out *photograph = &left_out->photograph[i];
        char name[32], caption[160];
        snprintf(name, sizeof name, "left-out-%d", i);
        snprintf(caption, sizeof caption, "%s left out: relative RMSE %.2f %%, median relative %.2f %%",
                 photograph->name, 100 * photograph->error.relative_rmse, 100 * photograph->error.median_relative);
        WEFT_TRY(weft_page_pair(page, name, &photograph->pair, caption, error));
    }
    return WEFT_OK;
}
