#include "capture/camera/tethered_shutter.h"

#include "capture/camera/camera.h"

#include <math.h>
#include <string.h>
#include <strings.h>

static int get_shutter(Camera *camera, GPContext *context, CameraWidget **widget, const char **key)
{
    static const char *const keys[] = {"shutterspeed", "shutterspeed2", "exptime"};
    int result = GP_ERROR_NOT_SUPPORTED;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        result = gp_camera_get_single_config(camera, keys[i], widget, context);
        *key = keys[i];
        if (result >= GP_OK)
            return result;
    }
    return result;
}

static const double rounding = 1.05; /* "1/60" is 1/64 */

/* The longest choice that is no longer than asked, for what is clipped is lost; else the shortest. NULL where none is a
 * time. */
static const char *best_choice(CameraWidget *widget, double exposure_s)
{
    const char *best = NULL;
    double found_s = 0;
    for (int i = 0; i < gp_widget_count_choices(widget); i++) {
        const char *choice;
        double seconds = gp_widget_get_choice(widget, i, &choice) >= GP_OK ? weft_shutter_seconds(choice) : 0;
        bool fits = seconds <= rounding * exposure_s, fitted = found_s <= rounding * exposure_s;
        bool better = !best || (fits && (!fitted || seconds > found_s)) || (!fits && !fitted && seconds < found_s);
        if (seconds > 0 && better) {
            found_s = seconds;
            best = choice;
        }
    }
    return best;
}

int weft_shutter_set(Camera *camera, GPContext *context, double exposure_s)
{
    CameraWidget *widget;
    const char *key, *value = NULL;
    int result = get_shutter(camera, context, &widget, &key);
    if (result < GP_OK)
        return result == GP_ERROR_NOT_SUPPORTED || result == GP_ERROR_BAD_PARAMETERS ? GP_OK : result;
    const char *choice = best_choice(widget, exposure_s);
    gp_widget_get_value(widget, &value);
    if (choice && (!value || strcmp(value, choice) != 0)) {
        gp_widget_set_value(widget, choice);
        result = gp_camera_set_single_config(camera, key, widget, context);
    }
    gp_widget_free(widget);
    return result;
}

double weft_shutter_reported(Camera *camera, GPContext *context)
{
    CameraWidget *widget;
    const char *key, *value = NULL;
    double seconds = 0;
    if (get_shutter(camera, context, &widget, &key) < GP_OK)
        return 0;
    if (gp_widget_get_value(widget, &value) >= GP_OK && value)
        seconds = weft_shutter_seconds(value);
    gp_widget_free(widget);
    return seconds;
}

/* ---- Exposures longer than the longest that the camera names ---- */

/* The longest of its times; 0 where it names none. */
static double longest_choice(CameraWidget *widget)
{
    double longest_s = 0;
    for (int i = 0; i < gp_widget_count_choices(widget); i++) {
        const char *choice;
        if (gp_widget_get_choice(widget, i, &choice) >= GP_OK)
            longest_s = fmax(longest_s, weft_shutter_seconds(choice));
    }
    return longest_s;
}

/* What opens the shutter until it is told to close. */
static const char bulb_key[] = "bulb";

static bool has_bulb(Camera *camera, GPContext *context)
{
    CameraWidget *widget;
    if (gp_camera_get_single_config(camera, bulb_key, &widget, context) < GP_OK)
        return false;
    gp_widget_free(widget);
    return true;
}

double weft_shutter_longest(Camera *camera, GPContext *context)
{
    CameraWidget *widget;
    const char *key;
    if (get_shutter(camera, context, &widget, &key) < GP_OK)
        return 0;
    double longest_s = longest_choice(widget);
    gp_widget_free(widget);
    return longest_s;
}

bool weft_shutter_needs_bulb(Camera *camera, GPContext *context, double longest_s, double exposure_s)
{
    return longest_s > 0 && exposure_s > rounding * longest_s && has_bulb(camera, context);
}

int weft_shutter_choose_bulb(Camera *camera, GPContext *context)
{
    CameraWidget *widget;
    const char *key, *choice;
    int result = get_shutter(camera, context, &widget, &key);
    if (result < GP_OK)
        return result;
    for (int i = 0; i < gp_widget_count_choices(widget); i++) {
        if (gp_widget_get_choice(widget, i, &choice) < GP_OK || strcasecmp(choice, "bulb") != 0)
            continue;
        gp_widget_set_value(widget, choice);
        result = gp_camera_set_single_config(camera, key, widget, context);
    }
    gp_widget_free(widget);
    return result;
}

int weft_shutter_press(Camera *camera, GPContext *context, int down)
{
    CameraWidget *widget;
    int result = gp_camera_get_single_config(camera, bulb_key, &widget, context);
    if (result < GP_OK)
        return result;
    gp_widget_set_value(widget, &down);
    result = gp_camera_set_single_config(camera, bulb_key, widget, context);
    gp_widget_free(widget);
    return result;
}
