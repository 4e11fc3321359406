/* Which poses of a plan show first what goes wrong. */
#ifndef WEFT_CAPTURE_PREFLIGHT_POSES_H
#define WEFT_CAPTURE_PREFLIGHT_POSES_H

#include "btf/session/session.h"

enum { WEFT_PREFLIGHT_POSES = 5 };

/* Numbers of shots: of the view nearest the zenith, then of up to four of the lowest ring of views, as far round from
 * each other as there are; each with the highest light that its view has. Returns how many there are. Pure. */
int weft_preflight_poses(const weft_session *session, int shot[WEFT_PREFLIGHT_POSES]);

#endif
