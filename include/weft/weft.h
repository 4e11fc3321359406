/* Weft: bidirectional texture functions from photographs to pictures. All of the library in one header. */
#ifndef WEFT_H
#define WEFT_H

#include "weft/compress.h"
#include "weft/dataset.h"
#include "weft/evaluate.h"
#include "weft/import.h"
#include "weft/inspect.h"
#include "weft/material.h"
#include "weft/progress.h"
#include "weft/register.h"
#include "weft/render.h"
#include "weft/status.h"
#include "weft/types.h"
#include "weft/version.h"

#endif
