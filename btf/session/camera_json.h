/* A camera, and how it was calibrated, as JSON: in session.json and in the files of lenses and rigs. */
#ifndef WEFT_BTF_SESSION_CAMERA_JSON_H
#define WEFT_BTF_SESSION_CAMERA_JSON_H

#include "btf/session/lens.h"

#include <jansson.h>
#include <stdbool.h>

/* The caller owns the reference; NULL where memory is short. p1, p2 and k3 are left out where all are 0. */
json_t *weft_camera_pack(const weft_camera *camera);

/* False where a field is missing or of the wrong type: `cause` tells which. p1, p2 and k3 may be missing: 0. Values are
 * not checked. */
bool weft_camera_unpack(json_t *json, weft_camera *camera, json_error_t *cause);

/* The standard errors of a lens by the names of its parameters. The caller owns the reference; NULL where memory is
 * short. */
json_t *weft_lens_pack_errors(const double error[WEFT_LENS_PARAMETERS]);

/* Puts the lists "used" and "left_out" of photographs, as weft_json_put does. */
void weft_lens_put_photographs(json_t **root, const weft_lens_photograph *photograph, int count);

#endif
