/* A camera as a JSON object, in session.json and in the file of a lens. */
#ifndef WEFT_BTF_SESSION_CAMERA_JSON_H
#define WEFT_BTF_SESSION_CAMERA_JSON_H

#include "btf/session/camera.h"

#include <jansson.h>
#include <stdbool.h>

/* The caller owns the reference; NULL where memory is short. p1, p2 and k3 are left out where all are 0. */
json_t *weft_camera_pack(const weft_camera *camera);

/* False where a field is missing or of the wrong type: `cause` tells which. p1, p2 and k3 may be missing: 0. Values are
 * not checked. */
bool weft_camera_unpack(json_t *json, weft_camera *camera, json_error_t *cause);

/* The nearest int: a value beyond is out of every range, too. */
int weft_limited_int(json_int_t value);

#endif
