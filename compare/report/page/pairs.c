#include "base/picture/colour.h"
#include "btf/direction/direction.h"
#include "compare/pictures/sample_picture.h"
#include "compare/report/page/sections.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

/* Small textures are shown large enough to see their texels. */
static int shown_width(const weft_image *image)
{
    int scale = 260 / image->width;
    return scale < 1 ? 260 : scale * image->width;
}

static weft_code put_picture(weft_page *page, const char *name, const char *what, weft_image *picture,
                             const char *caption, weft_error *error)
{
    char file[128];
    snprintf(file, sizeof file, "%s-%s", name, what);
    weft_code code = weft_page_picture(page, file, picture, shown_width(picture), caption, error);
    weft_image_free(picture);
    return code;
}

/* The colours of differences, as the pictures have them. */
static void put_scale(weft_page *page)
{
    enum { STOPS = 11 };
    fprintf(page->html,
            "<p class=\"note\">%.2f darker <span style=\"display:inline-block;width:220px;height:1em;"
            "vertical-align:-0.15em;background:linear-gradient(to right",
            WEFT_PICTURE_FULL_DIFFERENCE);
    for (int i = 0; i < STOPS; i++) {
        float rgb[3];
        weft_difference_colour(2 * (float)i / (STOPS - 1) - 1, rgb);
        fprintf(page->html, ",rgb(%.0f,%.0f,%.0f)", 255 * (double)rgb[0], 255 * (double)rgb[1], 255 * (double)rgb[2]);
    }
    fprintf(page->html, ")\"></span> %.2f brighter</p>\n", WEFT_PICTURE_FULL_DIFFERENCE);
}

static void explain_pictures(weft_page *page)
{
    fputs("<p class=\"note\">Reflectance in linear light, scaled so that the 99th percentile of the photograph is 0.9, "
          "shown as sRGB. Difference: mean of the channels under the same exposure, red where the prediction is "
          "brighter, "
          "blue where it "
          "is darker. Grey: masked.</p>\n",
          page->html);
    put_scale(page);
}

/* The photograph, then what each model makes of it. */
static weft_code put_models(weft_page *page, int index, const weft_comparison *comparison, weft_error *error)
{
    const weft_image_pair *photograph = &comparison->model[0].texture.pair[index];
    double exposure;
    char name[32], caption[64];
    WEFT_TRY(weft_picture_exposure(&photograph->sample, photograph->mask, &exposure, error));
    weft_image picture;
    snprintf(name, sizeof name, "texels-%d", index);
    fprintf(page->html, " (shown %.3g times brighter)</h3>\n<div class=\"row even\">\n", exposure);
    WEFT_TRY(weft_picture_encode(&photograph->sample, photograph->mask, exposure, &picture, error));
    WEFT_TRY(put_picture(page, name, "sample", &picture, "photograph", error));
    for (int i = 0; i < comparison->model_count; i++) {
        const weft_image_pair *pair = &comparison->model[i].texture.pair[index];
        const char *model = comparison->model[i].name;
        WEFT_TRY(weft_picture_encode(&pair->prediction, NULL, exposure, &picture, error));
        WEFT_TRY(put_picture(page, name, model, &picture, model, error));
        WEFT_TRY(weft_picture_difference(&pair->sample, &pair->prediction, pair->mask, exposure, &picture, error));
        char what[64];
        snprintf(what, sizeof what, "%s-difference", model);
        snprintf(caption, sizeof caption, "%s minus photograph", model);
        WEFT_TRY(put_picture(page, name, what, &picture, caption, error));
    }
    fputs("</div>\n", page->html);
    return WEFT_OK;
}

weft_code weft_page_pairs(weft_page *page, const weft_dataset_layout *layout, const weft_comparison *comparison,
                          weft_error *error)
{
    const weft_measurement *material = &comparison->model[0].texture;
    fputs("<h2 id=\"texels\">Texels</h2>\n", page->html);
    explain_pictures(page);
    for (int i = 0; i < material->pair_count; i++) {
        weft_image_angles at = weft_image_angles_of(layout, material->pair[i].image);
        fprintf(page->html, "<h3>Image %d: view %.0f\u00b0 (azimuth %.0f\u00b0), light %.0f\u00b0 (azimuth %.0f\u00b0)",
                material->pair[i].image, at.theta_view_deg, at.phi_view_deg, at.theta_light_deg, at.phi_light_deg);
        WEFT_TRY(put_models(page, i, comparison, error));
    }
    return WEFT_OK;
}

/* ---- Representative ---- */

static const double shown_theta_view_deg[WEFT_REPRESENTATIVE_COUNT] = {0, 30, 60, 75};
static const double shown_theta_light_deg = 30;

weft_image_angles weft_image_angles_of(const weft_dataset_layout *layout, int image)
{
    int x = layout->width / 2, y = layout->height / 2;
    weft_angles light = weft_angles_of_direction(weft_dataset_light_direction(layout, image, x, y));
    weft_angles view =
        weft_angles_of_direction(weft_dataset_view_direction(layout, layout->view_of_image[image], x, y));
    return (weft_image_angles){weft_deg_of_rad(light.theta_rad), weft_deg_of_rad(light.phi_rad),
                               weft_deg_of_rad(view.theta_rad), weft_deg_of_rad(view.phi_rad)};
}

/* How far an image is from the wanted one; the azimuth matters little, and not at all where one of the two is at the
 * zenith. */
static double distance(const weft_image_angles *at, double theta_view_deg)
{
    double aside = fabs(remainder(at->phi_light_deg - at->phi_view_deg, 360)) - 90;
    if (at->theta_view_deg < 1 || at->theta_light_deg < 1)
        aside = 0;
    double view = at->theta_view_deg - theta_view_deg, light = at->theta_light_deg - shown_theta_light_deg;
    return view * view + 0.25 * light * light + 0.01 * aside * aside;
}

int weft_representative_images(const weft_dataset_layout *layout, int image[WEFT_REPRESENTATIVE_COUNT])
{
    int count = 0;
    for (int i = 0; i < WEFT_REPRESENTATIVE_COUNT; i++) {
        double nearest = INFINITY;
        for (int candidate = 0; candidate < layout->image_count; candidate++) {
            weft_image_angles at = weft_image_angles_of(layout, candidate);
            bool shown = false;
            for (int k = 0; k < count; k++)
                shown = shown || image[k] == candidate;
            double d = distance(&at, shown_theta_view_deg[i]);
            if (!shown && d < nearest) {
                nearest = d;
                image[count] = candidate;
            }
        }
        count += nearest < INFINITY;
    }
    return count;
}
