#include "btf/session/lens.h"

#include "base/text/json_text.h"
#include "btf/session/camera_json.h"

#include <stdlib.h>
#include <string.h>

enum { LENS_VERSION = 1, MAX_LENS_BYTES = 1 << 24, MAX_SIDE = 32768 };

static const double largest_coefficient = 1e6;
static const weft_json_kind kind = {"weft_lens", LENS_VERSION, "is no lens", "is a lens"};

const char *const weft_lens_parameter_name[WEFT_LENS_PARAMETERS] = {"fx", "fy", "cx", "cy", "k1",
                                                                    "k2", "p1", "p2", "k3"};

double weft_lens_parameter(const weft_camera *c, int parameter)
{
    return (const double[WEFT_LENS_PARAMETERS]){
        c->fx, c->fy, c->cx, c->cy, c->k1, c->k2, c->p1, c->p2, c->k3}[parameter];
}

/* ---- Writing ---- */

json_t *weft_lens_pack_errors(const double error[WEFT_LENS_PARAMETERS])
{
    json_t *errors = json_object();
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++)
        weft_json_put(&errors, weft_lens_parameter_name[i], json_real(error[i]));
    return errors;
}

static json_t *pack_text(const char *text)
{
    return weft_json_text(text, strlen(text));
}

void weft_lens_put_photographs(json_t **root, const weft_lens_photograph *photograph, int count)
{
    json_t *used = json_array(), *left_out = json_array();
    for (int i = 0; i < count; i++) {
        if (!photograph[i].left_out)
            weft_json_append(&used, pack_text(photograph[i].name));
        else
            weft_json_append(&left_out, json_pack("{so so}", "photograph", pack_text(photograph[i].name), "reason",
                                                  pack_text(photograph[i].left_out)));
    }
    weft_json_put(root, "used", used);
    weft_json_put(root, "left_out", left_out);
}

weft_code weft_lens_write(const char *path, const weft_lens *lens, const char *board,
                          const weft_lens_photograph *photograph, int count, weft_error *error)
{
    json_t *root = json_pack("{si so}", "weft_lens", LENS_VERSION, "board", pack_text(board));
    json_t *camera = weft_camera_pack(&lens->camera);
    if (!root || json_object_update(root, camera) != 0) {
        json_decref(root);
        root = NULL;
    }
    json_decref(camera);
    weft_json_put(&root, "standard_error", weft_lens_pack_errors(lens->standard_error));
    weft_json_put(&root, "rms_px", json_real(lens->rms_px));
    weft_lens_put_photographs(&root, photograph, count);
    return weft_json_write(path, root, JSON_INDENT(1) | JSON_REAL_PRECISION(12), error);
}

/* ---- Reading ---- */

static weft_code check_camera(const weft_camera *c, const char *path, weft_error *error)
{
    if (c->width < 1 || c->height < 1 || c->width > MAX_SIDE || c->height > MAX_SIDE)
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': photographs of %d x %d pixels", path, c->width, c->height);
    if (!(c->fx > 0 && c->fy > 0))
        return weft_fail(error, WEFT_BAD_INPUT, "'%s': the focal length %g, %g pixels is not positive", path, c->fx,
                         c->fy);
    for (int i = 0; i < WEFT_LENS_PARAMETERS; i++) {
        double value = weft_lens_parameter(c, i);
        if (!(fabs(value) <= largest_coefficient))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': '%s' is %g, which no lens has", path,
                             weft_lens_parameter_name[i], value);
    }
    return WEFT_OK;
}

static bool unpack_errors(json_t *errors, weft_lens *lens, json_error_t *cause)
{
    for (int i = 0; errors && i < WEFT_LENS_PARAMETERS; i++)
        if (json_unpack_ex(errors, cause, 0, "{s?F}", weft_lens_parameter_name[i], &lens->standard_error[i]) != 0)
            return false;
    return true;
}

static weft_code unpack_lens(json_t *root, const char *path, weft_lens *lens, weft_error *error)
{
    json_error_t cause;
    json_t *errors = NULL;
    errno = 0;
    if (!weft_camera_unpack(root, &lens->camera, &cause) ||
        json_unpack_ex(root, &cause, 0, "{s?F s?o}", "rms_px", &lens->rms_px, "standard_error", &errors) != 0 ||
        !unpack_errors(errors, lens, &cause))
        return weft_json_fail(error, WEFT_BAD_INPUT, "'%s' lacks a field, or one has the wrong type: %s", path,
                              cause.text);
    return check_camera(&lens->camera, path, error);
}

weft_code weft_lens_read(const char *path, weft_lens *lens, weft_error *error)
{
    json_t *root = NULL;
    *lens = (weft_lens){0};
    WEFT_TRY(weft_json_read_kind(path, MAX_LENS_BYTES, &kind, &root, error));
    weft_code code = unpack_lens(root, path, lens, error);
    json_decref(root);
    return code;
}
