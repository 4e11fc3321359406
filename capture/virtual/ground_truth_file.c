#include "capture/virtual/ground_truth.h"

#include "base/atomic_file.h"

#include <hdf5.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The contents of the file, all owned. */
typedef struct truth {
    int viewpoint_count, shot_count, image_count, size;
    double *rotation;       /* [viewpoint][3][3] */
    double *translation_mm; /* [viewpoint][3] */
    double *light_mm;       /* [shot][3] */
    int *viewpoint;         /* [shot] */
    int *image_shot;        /* [image] */
    float *reflectance;     /* [image][size][size][3] */
} truth;

static void free_truth(truth *t)
{
    free(t->rotation);
    free(t->translation_mm);
    free(t->light_mm);
    free(t->viewpoint);
    free(t->image_shot);
    free(t->reflectance);
}

static weft_code allocate_truth(const weft_truth_request *request, const weft_session *session, truth *t,
                                weft_error *error)
{
    size_t shots = (size_t)session->shot_count, texels = (size_t)request->size * (size_t)request->size;
    *t = (truth){.viewpoint_count = 1, .shot_count = session->shot_count, .size = request->size};
    for (int i = 0; i < session->shot_count; i++)
        t->viewpoint_count =
            session->record[i].viewpoint >= t->viewpoint_count ? session->record[i].viewpoint + 1 : t->viewpoint_count;
    t->rotation = calloc((size_t)t->viewpoint_count * 9, sizeof *t->rotation);
    t->translation_mm = calloc((size_t)t->viewpoint_count * 3, sizeof *t->translation_mm);
    t->light_mm = calloc(shots * 3, sizeof *t->light_mm);
    t->viewpoint = calloc(shots, sizeof *t->viewpoint);
    t->image_shot = calloc((size_t)request->image_count, sizeof *t->image_shot);
    if (!t->rotation || !t->translation_mm || !t->light_mm || !t->viewpoint || !t->image_shot)
        return weft_fail_memory(error, "ground truth", shots * 3 * sizeof(double));
    t->image_count = weft_truth_choose(session, request->image_count, t->image_shot);
    t->reflectance = calloc((size_t)t->image_count * texels * 3, sizeof *t->reflectance);
    if (!t->reflectance)
        return weft_fail_memory(error, "true reflectance", (size_t)t->image_count * texels * 3 * sizeof(float));
    return WEFT_OK;
}

static void store_vector(double *place, weft_vec3 v)
{
    place[0] = v.x;
    place[1] = v.y;
    place[2] = v.z;
}

static void fill_poses(const weft_session *session, const weft_virtual_world *world, truth *t)
{
    for (int shot = 0; shot < session->shot_count; shot++) {
        int viewpoint = session->record[shot].viewpoint;
        weft_pose pose = weft_virtual_world_pose(world, session->shot[shot].view, viewpoint);
        memcpy(t->rotation + 9 * (size_t)viewpoint, pose.rotation, sizeof pose.rotation);
        store_vector(t->translation_mm + 3 * (size_t)viewpoint, pose.translation);
        weft_vec3 light = weft_virtual_world_light(world, session->shot[shot].light_driven, viewpoint);
        store_vector(t->light_mm + 3 * (size_t)shot, light);
        t->viewpoint[shot] = viewpoint;
    }
}

static void fill_image(const weft_session *session, const weft_virtual_rig *rig, int shot, int size, float *reflectance)
{
    int viewpoint = session->record[shot].viewpoint;
    weft_pose pose = weft_virtual_world_pose(&rig->world, session->shot[shot].view, viewpoint);
    weft_vec3 camera = weft_pose_camera_position(&pose);
    weft_vec3 light = weft_virtual_world_light(&rig->world, session->shot[shot].light_driven, viewpoint);
#pragma omp parallel for schedule(dynamic, 4)
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            weft_rgb value = weft_truth_reflectance(&rig->sample, size, x, y, light, camera);
            float *texel = reflectance + 3 * ((size_t)y * (size_t)size + (size_t)x);
            texel[0] = (float)value.r;
            texel[1] = (float)value.g;
            texel[2] = (float)value.b;
        }
    }
}

/* ---- The file ---- */

static bool write_array(hid_t file, const char *name, hid_t type, int rank, const hsize_t *shape, const void *values)
{
    hid_t space = H5Screate_simple(rank, shape, NULL);
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(creation, false);
    hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    bool written = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    if (set >= 0)
        written = H5Dclose(set) >= 0 && written;
    H5Sclose(space);
    return written;
}

static bool write_numbers(hid_t file, const char *name, int count, const double *values)
{
    hsize_t shape[1] = {(hsize_t)count};
    hid_t space = count > 1 ? H5Screate_simple(1, shape, NULL) : H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    bool written = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, values) >= 0;
    if (attribute >= 0)
        written = H5Aclose(attribute) >= 0 && written;
    H5Sclose(space);
    return written;
}

static bool write_camera(hid_t file, const weft_camera *c)
{
    return write_numbers(file, "fx", 1, &c->fx) && write_numbers(file, "fy", 1, &c->fy) &&
           write_numbers(file, "cx", 1, &c->cx) && write_numbers(file, "cy", 1, &c->cy) &&
           write_numbers(file, "k1", 1, &c->k1) && write_numbers(file, "k2", 1, &c->k2) &&
           write_numbers(file, "vignetting", 3, c->vignetting);
}

static bool write_arrays(hid_t file, const truth *t)
{
    hsize_t viewpoints = (hsize_t)t->viewpoint_count, shots = (hsize_t)t->shot_count, images = (hsize_t)t->image_count;
    hsize_t size = (hsize_t)t->size;
    hsize_t rotation[3] = {viewpoints, 3, 3}, translation[2] = {viewpoints, 3}, light[2] = {shots, 3};
    hsize_t reflectance[4] = {images, size, size, 3};
    return write_array(file, "rotation", H5T_NATIVE_DOUBLE, 3, rotation, t->rotation) &&
           write_array(file, "translation_mm", H5T_NATIVE_DOUBLE, 2, translation, t->translation_mm) &&
           write_array(file, "light_mm", H5T_NATIVE_DOUBLE, 2, light, t->light_mm) &&
           write_array(file, "viewpoint", H5T_NATIVE_INT, 1, &shots, t->viewpoint) &&
           write_array(file, "image_shot", H5T_NATIVE_INT, 1, &images, t->image_shot) &&
           write_array(file, "reflectance", H5T_NATIVE_FLOAT, 4, reflectance, t->reflectance);
}

static bool fill_file(hid_t file, const weft_camera *camera, double opening_mm, const truth *t)
{
    return write_camera(file, camera) && write_numbers(file, "opening_mm", 1, &opening_mm) && write_arrays(file, t) &&
           H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0;
}

/* The bytes of an open file that lives in memory; NULL where there is none to get. */
static void *take_image(hid_t file, size_t *size)
{
    ssize_t bytes = H5Fget_file_image(file, NULL, 0);
    void *image = bytes > 0 ? malloc((size_t)bytes) : NULL;
    if (image && H5Fget_file_image(file, image, (size_t)bytes) != bytes) {
        free(image);
        return NULL;
    }
    *size = image ? (size_t)bytes : 0;
    return image;
}

/* The whole file as bytes, which the caller frees. It is made in memory because HDF5 cannot close a file that a full
 * disk has cut, and crashes over it when the program ends. */
static void *make_image(const weft_camera *camera, double opening_mm, const truth *t, size_t *size)
{
    const size_t increment = 1 << 20;
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, increment, false);
    hid_t file = H5Fcreate("truth", H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    void *image = NULL;
    if (file >= 0) {
        image = fill_file(file, camera, opening_mm, t) ? take_image(file, size) : NULL;
        H5Fclose(file);
    }
    return image;
}

static weft_code write_file(const char *path, const weft_camera *camera, double opening_mm, const truth *t,
                            weft_error *error)
{
    size_t size = 0;
    void *image = make_image(camera, opening_mm, t, &size);
    if (!image)
        return weft_fail_memory(error, path, (size_t)t->image_count * (size_t)t->size * (size_t)t->size * 12);
    weft_code code = weft_write_file(path, image, size, error);
    free(image);
    return code;
}

void weft_beside_folder(const char *folder, const char *ending, char path[PATH_MAX])
{
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/')
        length--;
    snprintf(path, PATH_MAX, "%.*s%s", (int)length, folder, ending);
}

/* The path asked for, else FOLDER.truth.h5. */
static void choose_path(const weft_truth_request *request, const char *folder, char path[PATH_MAX])
{
    if (request->path)
        snprintf(path, PATH_MAX, "%s", request->path);
    else
        weft_beside_folder(folder, ".truth.h5", path);
}

weft_code weft_truth_check_path(const weft_truth_request *request, const weft_session *session, weft_error *error)
{
    char path[PATH_MAX];
    weft_atomic_file file;
    choose_path(request, session->folder, path);
    WEFT_TRY(weft_atomic_file_begin(path, &file, error));
    weft_atomic_file_abandon(&file);
    return WEFT_OK;
}

weft_code weft_truth_write(const weft_truth_request *request, const weft_session *session, const weft_virtual_rig *rig,
                           const weft_progress *progress, weft_error *error)
{
    truth t;
    char path[PATH_MAX];
    choose_path(request, session->folder, path);
    weft_sweep_left_over(path);
    weft_code code = allocate_truth(request, session, &t, error);
    if (code == WEFT_OK) {
        fill_poses(session, &rig->world, &t);
        size_t stride = (size_t)t.size * (size_t)t.size * 3;
        for (int image = 0; image < t.image_count; image++) {
            fill_image(session, rig, t.image_shot[image], t.size, t.reflectance + (size_t)image * stride);
            weft_progress_report(progress, "computing the ground truth", image + 1, t.image_count);
        }
        code = write_file(path, &rig->world.camera, rig->sample.opening_mm, &t, error);
    }
    free_truth(&t);
    return code;
}
