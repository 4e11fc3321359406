#include "capture/status/status_page.h"

#include "base/text/html_page.h"

/* Of all cameras; those that are left out take nothing more. */
static weft_status_counts sum_of(const weft_status_share *share, int count)
{
    weft_status_counts sum = {0};
    for (int i = 0; i < count; i++) {
        const weft_status_counts *one = &share[i].counts;
        sum.taken += one->taken;
        sum.taken_now += one->taken_now;
        sum.total += one->total;
        sum.seconds = one->seconds;
    }
    return sum;
}

static double time_to_go_s(const weft_status_share *share, int count)
{
    weft_status_counts sum = sum_of(share, count);
    int missing = 0;
    for (int i = 0; i < count; i++)
        missing += share[i].left_out ? 0 : share[i].counts.total - share[i].counts.taken;
    return sum.taken_now ? sum.seconds / sum.taken_now * missing : 0;
}

static void write_tiles(weft_page *page, const weft_status_share *share, int count)
{
    weft_status_counts sum = sum_of(share, count);
    double to_go_s = time_to_go_s(share, count);
    fputs("<div class=\"tiles\">", page->html);
    weft_page_tile(page, "cameras", "%d", count);
    weft_page_tile(page, "photographs", "%d of %d", sum.taken, sum.total);
    weft_page_tile(page, "time to go", "%d h %02d min", (int)(to_go_s / 3600), (int)(to_go_s / 60) % 60);
    fputs("</div>", page->html);
}

static const char *state_of(const weft_status_share *share)
{
    if (share->left_out)
        return "left out: ";
    if (share->failure)
        return "failed: ";
    return share->counts.taken == share->counts.total ? "has all" : "";
}

/* Names of cameras need no escape: they are names of folders on any disk. */
static void write_share(weft_page *page, const weft_status_share *share)
{
    const weft_status_counts *counts = &share->counts;
    fprintf(page->html, "<tr%s><td><a href=\"%s/index.html\">%s</a></td><td>%d of %d</td><td>%d</td><td>%d</td>",
            share->failure ? " class=\"bad\"" : "", share->camera, share->camera, counts->taken, counts->total,
            counts->damaged, counts->timeouts);
    fprintf(page->html, "<td>%d</td><td class=\"text\">%s", counts->disturbed, state_of(share));
    if (share->failure)
        weft_page_text(page, share->failure);
    fputs("</td></tr>", page->html);
}

static void write_shares(weft_page *page, const weft_status_share *share, int count)
{
    fputs("<h2>The cameras</h2><table>", page->html);
    weft_page_columns(page, "camera|photographs|damaged, taken again|exposures not delivered|the stage moved|:");
    for (int i = 0; i < count; i++)
        write_share(page, &share[i]);
    fputs("</table>", page->html);
}

weft_code weft_status_overview_write(const char *folder, const char *sample, const weft_status_share *share, int count,
                                     const char *why, weft_error *error)
{
    weft_page page;
    WEFT_TRY(weft_page_begin(folder, sample, &page, error));
    write_tiles(&page, share, count);
    write_shares(&page, share, count);
    if (why) {
        fputs("<p>The run ended early: ", page.html);
        weft_page_text(&page, why);
        fputs("</p>", page.html);
    }
    return weft_page_finish(&page, error);
}
