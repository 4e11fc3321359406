#include "registration/report.h"

#include "btf/atomic_file.h"
#include "registration/report_tables.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

static const char page_head[] =
    "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Registration</title>\n<style>\n"
    "body{font:15px/1.5 system-ui,sans-serif;color:#1c2430;background:#f6f7f9;margin:0}\n"
    "main{max-width:1180px;margin:0 auto;padding:28px 24px 60px}\n"
    "h1{font-size:26px;margin:0 0 4px}h2{font-size:19px;margin:40px 0 10px}p{max-width:78ch}\n"
    ".sub{color:#5b6675;margin:0 0 20px}\n"
    ".tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(165px,1fr));gap:12px}\n"
    ".tile{background:#fff;border:1px solid #dfe3e8;border-radius:8px;padding:12px 14px}\n"
    ".tile b{display:block;font-size:22px;font-weight:600}.tile span{color:#5b6675;font-size:13px}\n"
    "table{border-collapse:collapse;background:#fff;border:1px solid #dfe3e8;width:100%;font-size:13px;"
    "font-variant-numeric:tabular-nums}\n"
    "th,td{padding:5px 9px;text-align:right;border-bottom:1px solid #eceff2;white-space:nowrap}\n"
    "th{background:#eef1f4;color:#3c4755;font-weight:600;position:sticky;top:0}\n"
    "td.text,th.text{text-align:left;white-space:normal}\n"
    "tr.bad td{background:#fdecea}tr.weak td{background:#fff6df}\n"
    ".gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(360px,1fr));gap:14px}\n"
    "figure{margin:0;background:#fff;border:1px solid #dfe3e8;border-radius:8px;padding:10px}\n"
    "figure div{display:grid;grid-template-columns:repeat(3,1fr);gap:6px}\n"
    "figure img{width:100%;aspect-ratio:1;object-fit:contain;background:#20242a;image-rendering:auto}\n"
    "figure img.texels{image-rendering:pixelated}\n"
    "figcaption{font-size:13px;color:#3c4755;margin-top:6px}\n"
    "figure.bad{border-color:#d9483b}svg{background:#fff;border:1px solid #dfe3e8;border-radius:8px;width:100%}\n"
    "</style></head><body><main>\n";

static void write_tile(FILE *page, const char *value, const char *label)
{
    fprintf(page, "<div class=\"tile\"><b>%s</b><span>%s</span></div>\n", value, label);
}

static weft_code write_summary(FILE *page, const weft_session *session, const weft_registration *r, weft_error *error)
{
    char text[64];
    weft_ring_summary all;
    WEFT_TRY(weft_ring_summarise(session, r, -1, &all, error));
    fputs("<div class=\"tiles\">\n", page);
    snprintf(text, sizeof text, "%d of %d", r->image_count, session->shot_count);
    write_tile(page, text, "photographs in the dataset");
    snprintf(text, sizeof text, "%d of %d", r->survey.stay_count - r->failed_stays, r->survey.stay_count);
    write_tile(page, text, "stays of the camera registered");
    snprintf(text, sizeof text, "%.4f", all.median_uncertainty);
    write_tile(page, text, "texels: random error, median stay");
    snprintf(text, sizeof text, "%.4f", all.worst_uncertainty);
    write_tile(page, text, "texels: random error, worst stay");
    snprintf(text, sizeof text, "%.3f mm", all.median_shift_mm);
    write_tile(page, text, "median shift against the rig's promise");
    snprintf(text, sizeof text, "%.0f s", r->seconds);
    write_tile(page, text, "time taken");
    fputs("</div>\n", page);
    return WEFT_OK;
}

static void write_figure(FILE *page, const weft_registration *r, int stay)
{
    const weft_stay *one = &r->survey.stay[stay];
    const weft_view_pose *pose = &r->pose[stay];
    weft_angles view = r->survey.view[one->view];
    bool failed = pose->source == WEFT_POSE_FAILED;
    fprintf(page, "<figure%s><div>", failed ? " class=\"bad\"" : "");
    fprintf(page, "<img loading=\"lazy\" alt=\"photograph over drawing\" src=\"pictures/%03d_photograph.png\">", stay);
    if (pose->source == WEFT_POSE_DRAWING)
        fprintf(page, "<img loading=\"lazy\" alt=\"difference\" src=\"pictures/%03d_difference.png\">", stay);
    if (r->used[stay] > 0)
        fprintf(page, "<img class=\"texels\" loading=\"lazy\" alt=\"rectified\" src=\"pictures/%03d_texels.png\">",
                stay);
    fprintf(page, "</div><figcaption>%s, stay %d: %s</figcaption></figure>\n", weft_view_name_of(view).text, one->stay,
            failed ? "failed" : weft_pose_source_name(pose));
}

static void write_gallery(FILE *page, const weft_registration *r)
{
    fputs("<h2>Pictures</h2>\n<p>Left: the average of a stay's photographs in red over the drawn target in cyan; grey "
          "means "
          "that they agree. Middle: their difference, four times enlarged, on the print. Right: one photograph, "
          "rectified "
          "to texels.</p>\n<div class=\"gallery\">\n",
          page);
    for (int stay = 0; stay < r->survey.stay_count; stay++)
        write_figure(page, r, stay);
    fputs("</div>\n", page);
}

static weft_code write_page(FILE *page, const weft_session *session, const weft_registration *r, const char *dataset,
                            weft_error *error)
{
    fputs(page_head, page);
    fputs("<h1>Registration of ", page);
    weft_write_escaped(page, session->sample ? session->sample : "a sample");
    fputs("</h1>\n<p class=\"sub\">Session ", page);
    weft_write_escaped(page, session->folder);
    fputs(", dataset ", page);
    weft_write_escaped(page, dataset);
    fprintf(page, ", %d &times; %d texels of %.3f mm</p>\n", r->settings.width, r->settings.height,
            session->target.opening_mm / r->settings.width);
    WEFT_TRY(write_summary(page, session, r, error));
    weft_write_faults(page, session, r);
    WEFT_TRY(weft_write_rings(page, session, r, error));
    WEFT_TRY(weft_write_whites(page, session, r, error));
    write_gallery(page, r);
    weft_write_stays(page, session, r);
    fputs("</main></body></html>\n", page);
    return WEFT_OK;
}

weft_code weft_report_write_page(const weft_session *session, const weft_registration *registration,
                                 const char *dataset, weft_error *error)
{
    char path[PATH_MAX], *text = NULL;
    size_t size = 0;
    if (snprintf(path, sizeof path, "%s/index.html", registration->settings.report_folder) >= (int)sizeof path)
        return weft_fail(error, WEFT_BAD_USAGE, "the report's folder has too long a name");
    FILE *page = open_memstream(&text, &size);
    if (!page)
        return weft_fail_memory(error, "the report", 1 << 16);
    weft_code code = write_page(page, session, registration, dataset, error);
    bool broken = ferror(page) != 0;
    if ((fclose(page) != 0 || broken) && code == WEFT_OK)
        code = weft_fail_memory(error, "the report", size);
    if (code == WEFT_OK)
        code = weft_write_file(path, text, size, error);
    free(text);
    return code;
}
