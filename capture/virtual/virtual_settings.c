#include "capture/virtual/virtual_settings.h"

#include "base/text/json_text.h"
#include "geometry/light/stitch_sample.h"

#include <string.h>

enum { GROUP_COUNT = 5 };

#define REAL(name, value, low, high) WEFT_SETTING(weft_virtual_settings, name, value, low, high, false)
#define WHOLE(name, value, low, high) WEFT_SETTING(weft_virtual_settings, name, value, low, high, true)

static const weft_rig_setting table[] = {
    REAL(full_well_electrons, 240000, 100, 1e7),
    REAL(read_noise_electrons, 10, 0, 1000),
    REAL(sensitivity_electrons, 2e7, 1, 1e12),
    REAL(aperture_mm, 4, 0, 100),
    WHOLE(samples_per_pixel, 12, 1, 64),
    REAL(focal_length_error, 0.0005, -0.1, 0.1),
    REAL(principal_point_error_px, 0.2, 0, 10),
    REAL(k1_error, 0.02, -0.5, 0.5),
    REAL(mounting_rotation_deg, 0.3, 0, 5),
    REAL(mounting_translation_mm, 0.3, 0, 10),
    REAL(viewpoint_rotation_deg, 0.05, 0, 5),
    REAL(viewpoint_translation_mm, 0.1, 0, 10),
    REAL(light_rotation_deg, 0.05, 0, 5),
    REAL(light_power_drift, 0.002, 0, 0.1),
    REAL(timeout_probability, 0, 0, 0.9),
    WHOLE(tiles_x, 0, 0, 10000),
    WHOLE(tiles_y, 0, 0, 10000),
    WHOLE(cloth_noise, 1, 0, 1),
    WHOLE(bounces, 3, 0, WEFT_STITCH_SAMPLE_MAX_BOUNCES),
};

/* Sessions of rigs without axes say nothing of them, as they did before there were any. */
static const weft_rig_setting axes_table[] = {
    WHOLE(axes, 0, 0, 1),           REAL(axis_tilt_deg, 0, 0, 5),    REAL(axis_offset_mm, 0, 0, 50),
    REAL(axis_zero_deg, 0, 0, 5),   REAL(axis_scale, 0, 0, 0.1),     REAL(axis_uneven_deg, 0, 0, 5),
    REAL(axis_wobble_deg, 0, 0, 5), REAL(aim_rotation_deg, 0, 0, 5), REAL(aim_mm, 0, 0, 50),
};

/* Nor do those of sensors without faults and frames. Dark current: 4 binned pixels of 50 electrons/s (Kodak KAF-0400 at
 * 25 degrees C), hot ones 10 to 20 times that (Dalsa 1M150, manual); response: 1 % a pixel, halved by binning. */
static const weft_rig_setting sensor_table[] = {
    WHOLE(sensor_faults, 0, 0, 1),
    REAL(dark_electrons, 200, 0, 1e6),
    REAL(dark_spread, 0.2, 0, 1),
    REAL(hot_share, 0.001, 0, 0.1),
    REAL(hot_factor, 15, 1, 1e4),
    REAL(response_spread, 0.005, 0, 0.2),
    WHOLE(dust_specks, 20, 0, 1000),
    REAL(dust_depth, 0.1, 0, 0.9),
    REAL(field_slope, 0.005, -0.5, 0.5),
    WHOLE(dark_frames, 0, 0, WEFT_SESSION_MAX_FRAMES),
    WHOLE(flat_frames, 0, 0, WEFT_SESSION_MAX_FRAMES),
};

/* Nor do those of one camera. */
static const weft_rig_setting cameras_table[] = {
    WHOLE(cameras, 1, 1, WEFT_VIRTUAL_CAMERAS_MAX),
};

static void list_groups(weft_virtual_settings *settings, weft_setting_group groups[GROUP_COUNT])
{
    groups[0] = weft_rig_settings_group(&settings->rig);
    groups[1] = (weft_setting_group){table, sizeof table / sizeof *table, settings};
    groups[2] = (weft_setting_group){axes_table, sizeof axes_table / sizeof *axes_table, settings};
    groups[3] = (weft_setting_group){sensor_table, sizeof sensor_table / sizeof *sensor_table, settings};
    groups[4] = (weft_setting_group){cameras_table, sizeof cameras_table / sizeof *cameras_table, settings};
}

weft_virtual_settings weft_virtual_settings_default(void)
{
    weft_virtual_settings settings;
    weft_setting_group groups[GROUP_COUNT];
    list_groups(&settings, groups);
    for (int i = 0; i < GROUP_COUNT; i++)
        weft_setting_group_reset(&groups[i]);
    return settings;
}

weft_code weft_virtual_settings_read(const char *path, weft_virtual_settings *settings, weft_error *error)
{
    weft_setting_group groups[GROUP_COUNT];
    list_groups(settings, groups);
    WEFT_TRY(weft_setting_groups_read(path, "virtual", groups, GROUP_COUNT, error));
    return weft_rig_settings_check(&settings->rig, path, error);
}

char *weft_virtual_settings_text(const weft_virtual_settings *settings, uint64_t seed, const char *sample_file,
                                 uint32_t sample_crc32)
{
    weft_virtual_settings copy = *settings;
    weft_setting_group groups[GROUP_COUNT];
    list_groups(&copy, groups);
    json_t *root =
        json_pack("{sI so sI}", "seed", (json_int_t)seed, "sample_file",
                  weft_json_text(sample_file, strlen(sample_file)), "sample_crc32", (json_int_t)sample_crc32);
    bool sensor = copy.sensor_faults != 0 || copy.dark_frames > 0 || copy.flat_frames > 0;
    const bool written[GROUP_COUNT] = {true, true, copy.axes != 0, sensor, copy.cameras > 1};
    for (int i = 0; root && i < GROUP_COUNT; i++) {
        if (written[i])
            weft_setting_group_write(&groups[i], &root);
    }
    char *text = root ? json_dumps(root, JSON_COMPACT | JSON_REAL_PRECISION(15)) : NULL;
    json_decref(root);
    return text;
}
