#include "btf/session/camera_json.h"

#include "base/integers.h"
#include "base/text/json_text.h"

json_t *weft_camera_pack(const weft_camera *c)
{
    json_t *camera = json_pack("{si si sf sf sf sf sf sf s[fff]}", "width", c->width, "height", c->height, "fx", c->fx,
                               "fy", c->fy, "cx", c->cx, "cy", c->cy, "k1", c->k1, "k2", c->k2, "vignetting",
                               c->vignetting[0], c->vignetting[1], c->vignetting[2]);
    if (camera && (c->p1 != 0 || c->p2 != 0 || c->k3 != 0)) {
        weft_json_put(&camera, "p1", json_real(c->p1));
        weft_json_put(&camera, "p2", json_real(c->p2));
        weft_json_put(&camera, "k3", json_real(c->k3));
    }
    return camera;
}

bool weft_camera_unpack(json_t *json, weft_camera *c, json_error_t *cause)
{
    json_int_t width = 0, height = 0;
    bool done = json_unpack_ex(json, cause, 0, "{sI sI sF sF sF sF sF sF s?F s?F s?F s[FFF]}", "width", &width,
                               "height", &height, "fx", &c->fx, "fy", &c->fy, "cx", &c->cx, "cy", &c->cy, "k1", &c->k1,
                               "k2", &c->k2, "p1", &c->p1, "p2", &c->p2, "k3", &c->k3, "vignetting", &c->vignetting[0],
                               &c->vignetting[1], &c->vignetting[2]) == 0;
    c->width = weft_limited_int(width);
    c->height = weft_limited_int(height);
    return done;
}
