#include "plate_session.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "plate.h"
#include "tests/support/cmocka_all.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const plate_faults plate_no_faults = {-1, -1, -1};

static const double camera_mm = 600, light_mm = 650;
static const weft_angles view_of[PLATE_SESSION_VIEWS] = {{0, 0}, {0.7, 1}, {1.1, 4}};
static const weft_angles light_of[PLATE_SESSION_LIGHTS] = {{0.2, 3}, {0.8, 0}, {1.2, 2}};

static double diffuser(double x_mm, double y_mm)
{
    (void)x_mm, (void)y_mm;
    return PLATE_SESSION_SAMPLE;
}

/* A fresh description; names are allocated as weft_session_free expects them. */
static weft_session describe(const char *folder)
{
    weft_session s = {.folder = strdup(folder), .rig = strdup("test"), .sample = strdup("diffuser")};
    s.rig_settings = strdup("{}");
    s.camera = plate_camera(PLATE_SESSION_SIZE, camera_mm);
    s.camera_distance_mm = camera_mm;
    s.light_distance_mm = light_mm;
    s.bits = 12;
    s.black_level = 64;
    s.target = weft_target_for_opening(32);
    s.shot_count = PLATE_SESSION_SHOTS;
    s.shot = calloc(PLATE_SESSION_SHOTS, sizeof *s.shot);
    s.record = calloc(PLATE_SESSION_SHOTS, sizeof *s.record);
    for (int i = 0; i < PLATE_SESSION_SHOTS; i++) {
        weft_angles light = light_of[i % PLATE_SESSION_LIGHTS];
        s.shot[i] = (weft_shot){light, view_of[i / PLATE_SESSION_LIGHTS], light};
    }
    return s;
}

/* Raw values of a picture of the plate under even light, relit by a near light. */
static void expose(const weft_session *s, const float *even, const weft_pose *pose, weft_angles light,
                   double exposure_s, uint16_t *raw)
{
    weft_homography homography = weft_homography_of_pose(&s->camera, pose);
    weft_homography inverse = weft_homography_inverse(&homography);
    weft_vec3 from = weft_scale(weft_direction_of_angles(light), light_mm);
    for (int i = 0; i < PLATE_SESSION_SIZE * PLATE_SESSION_SIZE; i++) {
        weft_pixel pixel = {i % PLATE_SESSION_SIZE, i / PLATE_SESSION_SIZE};
        pixel = weft_camera_undistort(&s->camera, pixel);
        weft_pixel plate = weft_homography_apply(&inverse, pixel.x, pixel.y);
        weft_vec3 to_light = weft_subtract(from, (weft_vec3){plate.x, plate.y, 0});
        double r = weft_length(to_light), irradiance = to_light.z / r * light_mm * light_mm / (r * r);
        double value = 64 + 4000 * exposure_s * (double)even[i] * irradiance + 0.5;
        for (int c = 0; c < 3; c++)
            raw[3 * i + c] = (uint16_t)weft_clamp(value, 0, 4095);
    }
}

static void take_view(weft_session *s, int view, const plate_faults *faults)
{
    plate_scene scene = {s->target, 0, 0.002, 10, view == faults->covered_view ? 2 : 0, diffuser};
    weft_pose pose = plate_jittered_pose(view_of[view], camera_mm, (unsigned)view + 20);
    float *even = plate_photograph(&scene, &s->camera, &pose, (unsigned)view + 1);
    uint16_t *raw = malloc(sizeof *raw * PLATE_SESSION_SIZE * PLATE_SESSION_SIZE * 3);
    assert_non_null(raw);
    for (int light = 0; light < PLATE_SESSION_LIGHTS; light++) {
        int shot = view * PLATE_SESSION_LIGHTS + light;
        char path[512], parent[512];
        weft_shot_record record = {.taken = true,
                                   .viewpoint = view,
                                   .exposure_s = shot == faults->overexposed ? 2.2 : 0.9,
                                   .bytes = 1,
                                   .crc32 = 1};
        if (shot == faults->untaken)
            continue;
        expose(s, even, &pose, light_of[light], record.exposure_s, raw);
        weft_session_photograph_path(s, shot, path, sizeof path);
        snprintf(parent, sizeof parent, "%s", path);
        *strrchr(parent, '/') = 0;
        assert_int_equal(weft_make_folder(parent, NULL), WEFT_OK);
        assert_int_equal(weft_photograph_write(path, PLATE_SESSION_SIZE, PLATE_SESSION_SIZE, 12, raw, NULL), WEFT_OK);
        assert_int_equal(weft_session_append(s, shot, &record, NULL), WEFT_OK);
    }
    free(raw);
    free(even);
}

void plate_session_write(const char *folder, const plate_faults *faults)
{
    weft_session session = describe(folder);
    assert_int_equal(weft_make_folder(folder, NULL), WEFT_OK);
    assert_int_equal(weft_session_create(&session, NULL), WEFT_OK);
    for (int view = 0; view < PLATE_SESSION_VIEWS; view++)
        take_view(&session, view, faults);
    weft_session_free(&session);
}

void plate_session_photograph(const char *folder, int shot, char path[512])
{
    weft_session session;
    assert_int_equal(weft_session_open(folder, &session, NULL), WEFT_OK);
    weft_session_photograph_path(&session, shot, path, 512);
    weft_session_free(&session);
}
