#include "registration/report/report.h"

#include "registration/report/tables.h"

#include <stdio.h>
#include <stdlib.h>

static weft_code write_summary(weft_page *page, const weft_session *session, const weft_registration *r,
                               weft_error *error)
{
    weft_ring_summary all;
    WEFT_TRY(weft_ring_summarise(session, r, -1, &all, error));
    fputs("<div class=\"tiles\">\n", page->html);
    weft_page_tile(page, "photographs in the dataset", "%d of %d", r->image_count, session->shot_count);
    weft_page_tile(page, "viewpoints of the camera registered", "%d of %d",
                   r->survey.viewpoint_count - r->failed_viewpoints, r->survey.viewpoint_count);
    weft_page_tile(page, "thousandths of a texel: random error, median viewpoint", "%.2f",
                   1000 * all.median_uncertainty);
    weft_page_tile(page, "thousandths of a texel: random error, worst viewpoint", "%.2f", 1000 * all.worst_uncertainty);
    weft_page_tile(page, "median shift against the rig's promise", "%.3f mm", all.median_shift_mm);
    if (session->colour.terms > 0)
        weft_page_tile(page, "CIEDE2000: linear sRGB, of a chart's patch left out", "%.2f",
                       session->colour.left_out.mean);
    weft_page_tile(page, "time taken", "%.0f s", r->seconds);
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

static void write_figure(weft_page *page, const weft_registration *r, int viewpoint)
{
    const weft_viewpoint *one = &r->survey.viewpoint[viewpoint];
    const weft_view_pose *pose = &r->pose[viewpoint];
    weft_angles view = r->survey.view[one->view];
    bool failed = pose->source == WEFT_POSE_FAILED;
    fprintf(page->html, "<figure%s><div>", failed ? " class=\"bad\"" : "");
    fprintf(page->html, "<img loading=\"lazy\" alt=\"photograph over drawing\" src=\"pictures/%03d_photograph.png\">",
            viewpoint);
    if (pose->source == WEFT_POSE_DRAWING)
        fprintf(page->html, "<img loading=\"lazy\" alt=\"difference\" src=\"pictures/%03d_difference.png\">",
                viewpoint);
    if (r->used[viewpoint] > 0)
        fprintf(page->html,
                "<img class=\"texels\" loading=\"lazy\" alt=\"rectified\" src=\"pictures/%03d_texels.png\">",
                viewpoint);
    fprintf(page->html,
            "</div><figcaption>%.0f\u00b0 from the normal, azimuth %.0f\u00b0 (%s), viewpoint %d: "
            "%s%s</figcaption></figure>\n",
            weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad), weft_view_name_of(view).text,
            one->viewpoint, failed ? "failed" : "pose from ", failed ? "" : weft_pose_source_name(pose));
}

static void write_gallery(weft_page *page, const weft_registration *r)
{
    fputs("<h2>Pictures</h2>\n<p>Left: the average of a viewpoint's photographs in red over the drawn target in cyan; "
          "grey "
          "means "
          "that they agree. Middle: their difference, four times enlarged, on the print. Right: one photograph, "
          "rectified "
          "to texels.</p>\n<div class=\"gallery\">\n",
          page->html);
    for (int viewpoint = 0; viewpoint < r->survey.viewpoint_count; viewpoint++)
        write_figure(page, r, viewpoint);
    fputs("</div>\n", page->html);
}

static weft_code write_page(weft_page *page, const weft_session *session, const weft_registration *r,
                            const char *dataset, weft_error *error)
{
    fputs("<p class=\"note\">Session ", page->html);
    weft_page_text(page, session->folder);
    fputs(", dataset ", page->html);
    weft_page_text(page, dataset);
    fprintf(page->html, ", %d \u00d7 %d texels of %.3f mm</p>\n", r->settings.width, r->settings.height,
            session->target.opening_mm / r->settings.width);
    WEFT_TRY(write_summary(page, session, r, error));
    weft_write_faults(page, session, r);
    WEFT_TRY(weft_write_rings(page, session, r, error));
    WEFT_TRY(weft_write_whites(page, session, r, error));
    weft_write_rig(page, session, r);
    write_gallery(page, r);
    weft_write_viewpoints(page, session, r);
    return WEFT_OK;
}

weft_code weft_report_write_page(const weft_session *session, const weft_registration *registration,
                                 const char *dataset, weft_error *error)
{
    weft_page page;
    char *title;
    if (asprintf(&title, "Registration of %s", session->sample ? session->sample : "a sample") < 0)
        return weft_fail_memory(error, "the report", 0);
    weft_code code = weft_page_begin(registration->settings.report_folder, title, &page, error);
    free(title);
    WEFT_TRY(code);
    code = write_page(&page, session, registration, dataset, error);
    if (code == WEFT_OK)
        return weft_page_finish(&page, error);
    weft_page_abandon(&page);
    return code;
}
