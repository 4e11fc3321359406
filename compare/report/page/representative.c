#include "compare/report/page/sections.h"

#include "btf/direction/direction.h"

#include <math.h>
#include <stdbool.h>

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
