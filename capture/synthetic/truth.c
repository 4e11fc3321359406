#include "capture/synthetic/synthetic.h"

#include "base/atomic_file.h"
#include "base/text/json_text.h"
#include "btf/dataset/dataset.h"
#include "capture/virtual/ground_truth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- JSON ---- */

static json_t *vector_of(weft_vec3 v)
{
    return json_pack("[fff]", v.x, v.y, v.z);
}

static json_t *lens_json(const weft_synthetic_lens *lens)
{
    return json_pack("{si si sf sf s[ff] s[ff] sf sf}", "width", lens->width, "height", lens->height, "sensor_width_mm",
                     lens->sensor_width_mm, "focal_length_mm", lens->focal_length_mm, "axis_px", lens->axis_x,
                     lens->axis_y, "division", lens->division[0], lens->division[1], "rim_mm", lens->rim_mm,
                     "rim_radius_mm", lens->rim_radius_mm);
}

static json_t *pose_json(const weft_pose *pose)
{
    const double(*r)[3] = pose->rotation;
    return json_pack("{s[[fff][fff][fff]] so so}", "rotation", r[0][0], r[0][1], r[0][2], r[1][0], r[1][1], r[1][2],
                     r[2][0], r[2][1], r[2][2], "translation_mm", vector_of(pose->translation), "camera_mm",
                     vector_of(weft_pose_camera_position(pose)));
}

static json_t *lamp_json(const weft_synthetic_lamp *lamp)
{
    return json_pack("{ss so so sf sf s[fff]}", "shape", lamp->is_disc ? "disc" : "ball", "at_mm", vector_of(lamp->at),
                     "axis", vector_of(lamp->axis), "radius_mm", lamp->radius_mm, "intensity_cd", lamp->intensity_cd,
                     "colour", lamp->colour.r, lamp->colour.g, lamp->colour.b);
}

static json_t *exposure_json(const weft_synthetic_exposure *e)
{
    return json_pack("{sf sf sf sf s[fff]}", "seconds", e->seconds, "f_number", e->f_number, "iso", e->iso, "gain",
                     e->gain, "white_balance", e->white_balance[0], e->white_balance[1], e->white_balance[2]);
}

static json_t *shot_json(const weft_synthetic_shot *shot)
{
    return json_pack(
        "{ss ss sb si so sf sf sf so so}", "name", shot->name, "fault", weft_synthetic_fault_name(shot->fault),
        "hand_shadow", shot->hand_shadow, "orientation", shot->orientation, "pose", pose_json(&shot->pose),
        "image_distance_mm", shot->lens.image_distance_mm, "focus_mm", shot->lens.focus_mm, "pupil_radius_mm",
        shot->lens.pupil_radius_mm, "lamp", lamp_json(&shot->lamp), "exposure", exposure_json(&shot->exposure));
}

/* The tone curve at linear = i / 1024. */
static json_t *tone_json(const weft_synthetic_request *request)
{
    json_t *list = json_array();
    for (int i = 0; i <= 1024; i++) {
        double linear = i / 1024.0;
        weft_json_append(
            &list,
            json_real(request->format == WEFT_SYNTHETIC_JPEG ? weft_synthetic_tone(request->curve, linear) : linear));
    }
    return list;
}

static json_t *truth_json(const weft_synthetic_request *request, const weft_synthetic_shot *shot)
{
    static const char *const set[] = {"free", "flash", "tripod", "stepped"};
    json_t *photographs = json_array();
    for (int i = 0; i < request->photograph_count; i++)
        weft_json_append(&photographs, shot_json(&shot[i]));
    return json_pack("{ss so sI sf sb sb sf sf so so so}", "set", set[request->set], "content",
                     weft_json_text(request->content, strlen(request->content)), "seed", (json_int_t)request->seed,
                     "opening_mm", request->opening_mm, "balls", !request->no_balls, "pin", !request->no_pin,
                     "window_cd_m2", request->window, "gloss", request->gloss, "lens", lens_json(&shot[0].lens),
                     "photographs", photographs, "tone", tone_json(request));
}

weft_code weft_synthetic_truth_write(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                     weft_error *error)
{
    char path[PATH_MAX];
    weft_beside_folder(request->folder, ".truth.json", path);
    json_t *root = truth_json(request, shot);
    char *text = root ? json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(12)) : NULL;
    json_decref(root);
    if (!text)
        return weft_fail_memory(error, path, 0);
    weft_code code = weft_write_file(path, text, strlen(text), error);
    free(text);
    return code;
}

/* ---- Notes ---- */

/* In the picture as it is shown: x right, y up, z to the camera. */
static weft_vec3 in_picture(const weft_synthetic_shot *shot, weft_vec3 v)
{
    const double(*r)[3] = shot->pose.rotation;
    double right = r[0][0] * v.x + r[0][1] * v.y + r[0][2] * v.z, down = r[1][0] * v.x + r[1][1] * v.y + r[1][2] * v.z;
    double back = -(r[2][0] * v.x + r[2][1] * v.y + r[2][2] * v.z);
    if (shot->orientation == 6)
        return weft_vec3_of(-down, -right, back);
    if (shot->orientation == 8)
        return weft_vec3_of(down, right, back);
    return weft_vec3_of(right, -down, back);
}

static void print_notes(const weft_synthetic_request *request, const weft_synthetic_shot *shot, FILE *stream)
{
    if (request->set == WEFT_SYNTHETIC_TRIPOD)
        fprintf(stream, "%d\n", request->photograph_count);
    else
        fputs("file,theta_view_deg,phi_view_deg\n", stream);
    for (int i = 0; i < request->photograph_count; i++) {
        weft_vec3 light = in_picture(&shot[i], weft_unit(shot[i].lamp.at));
        if (request->set == WEFT_SYNTHETIC_TRIPOD)
            fprintf(stream, "%s %.6f %.6f %.6f\n", shot[i].name, light.x, light.y, light.z);
        else
            fprintf(stream, "%s,%.4f,%.4f\n", shot[i].name, weft_deg_of_rad(shot[i].nominal_theta_rad),
                    weft_deg_of_rad(shot[i].nominal_phi_rad));
    }
}

weft_code weft_synthetic_write_notes(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                     weft_error *error)
{
    char path[PATH_MAX], *text = NULL;
    size_t size = 0;
    if (request->set != WEFT_SYNTHETIC_TRIPOD && request->set != WEFT_SYNTHETIC_STEPPED)
        return WEFT_OK;
    weft_beside_folder(request->folder, request->set == WEFT_SYNTHETIC_TRIPOD ? ".lp" : ".steps.csv", path);
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return weft_fail_memory(error, path, 0);
    print_notes(request, shot, stream);
    weft_code code =
        fclose(stream) == 0 ? weft_write_file(path, text, size, error) : weft_fail_memory(error, path, size);
    free(text);
    return code;
}

/* ---- Reflectance ---- */

static void fill_layout(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                        weft_dataset_layout *layout)
{
    for (int i = 0; i < request->photograph_count; i++) {
        layout->light[i] = shot[i].lamp.at;
        layout->view[i] = weft_pose_camera_position(&shot[i].pose);
        layout->view_of_image[i] = i;
    }
}

static void fill_image(const weft_virtual_sample *content, const weft_synthetic_shot *shot, int size,
                       weft_half *samples)
{
    weft_vec3 camera = weft_pose_camera_position(&shot->pose);
#pragma omp parallel for schedule(dynamic, 1)
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            weft_rgb value = weft_truth_reflectance(content, size, x, y, shot->lamp.at, camera);
            weft_half *texel = samples + 3 * ((size_t)y * (size_t)size + (size_t)x);
            texel[0] = weft_half_of_float((float)value.r);
            texel[1] = weft_half_of_float((float)value.g);
            texel[2] = weft_half_of_float((float)value.b);
        }
    }
}

static weft_code put_images(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                            const weft_virtual_sample *content, weft_dataset_writer *writer,
                            const weft_progress *progress, weft_error *error)
{
    size_t size = (size_t)request->truth_size;
    weft_half *samples = malloc(size * size * 3 * sizeof *samples);
    if (!samples)
        return weft_fail_memory(error, "the truth", size * size * 3 * sizeof *samples);
    weft_code code = WEFT_OK;
    for (int i = 0; code == WEFT_OK && i < request->photograph_count; i++) {
        if (shot[i].fault == WEFT_SYNTHETIC_GOOD) {
            fill_image(content, &shot[i], request->truth_size, samples);
            code = weft_dataset_writer_put_image(writer, i, samples, NULL, error);
        }
        weft_progress_report(progress, "computing the truth", i + 1, request->photograph_count);
    }
    free(samples);
    return code;
}

static weft_code write_dataset(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                               const weft_virtual_sample *content, const weft_dataset_layout *layout,
                               const weft_progress *progress, weft_error *error)
{
    char path[PATH_MAX];
    weft_dataset_writer *writer;
    weft_beside_folder(request->folder, ".truth.btf.h5", path);
    WEFT_TRY(weft_dataset_writer_create(path, layout, &writer, error));
    weft_code code = put_images(request, shot, content, writer, progress, error);
    if (code != WEFT_OK) {
        weft_dataset_writer_abandon(writer);
        return code;
    }
    return weft_dataset_writer_finish(writer, NULL, error);
}

weft_code weft_synthetic_truth_write_reflectance(const weft_synthetic_request *request, const weft_synthetic_shot *shot,
                                                 const weft_virtual_sample *content, const weft_progress *progress,
                                                 weft_error *error)
{
    weft_dataset_layout layout = {.width = request->truth_size,
                                  .height = request->truth_size,
                                  .image_count = request->photograph_count,
                                  .view_count = request->photograph_count,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = WEFT_NEAR,
                                  .texel_pitch_mm = request->opening_mm / request->truth_size};
    weft_code code = weft_dataset_layout_allocate(&layout, error);
    if (code == WEFT_OK) {
        fill_layout(request, shot, &layout);
        code = write_dataset(request, shot, content, &layout, progress, error);
    }
    weft_dataset_layout_free(&layout);
    return code;
}
