/* What goes wrong with photographs of a hand. */
#ifndef WEFT_CAPTURE_HAND_MISHAP_H
#define WEFT_CAPTURE_HAND_MISHAP_H

#include "capture/hand/dice.h"
#include "capture/hand/plan.h"

/* The rubbish lies evenly among the photographs, each kind in turn. Pure. */
weft_snap_fault weft_snap_fault_of(const weft_snap_request *request, int photograph);

/* Where the hand of a shot is. One that shades keeps out of the picture of the opening if it can; one over the plate
 * does not. Pure. */
void weft_snap_place_hand(const weft_snap_request *request, weft_dice *d, weft_snap_shot *shot);

/* What the fault of a shot does to its exposure and its pose. Pure. */
void weft_snap_spoil(weft_dice *d, weft_snap_shot *shot);

#endif
