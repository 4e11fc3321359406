/* What goes wrong with photographs of a hand. */
#ifndef WEFT_CAPTURE_SYNTHETIC_FAULTS_H
#define WEFT_CAPTURE_SYNTHETIC_FAULTS_H

#include "capture/synthetic/dice.h"
#include "capture/synthetic/plan.h"

/* The rubbish lies evenly among the photographs, each kind in turn. Pure. */
weft_synthetic_fault weft_synthetic_fault_of(const weft_synthetic_request *request, int photograph);

/* Where the hand of a shot is. One that shades keeps out of the picture of the opening if it can; one over the plate
 * does not. Pure. */
void weft_synthetic_place_hand(const weft_synthetic_request *request, weft_dice *d, weft_synthetic_shot *shot);

/* What the fault of a shot does to its exposure and its pose. Pure. */
void weft_synthetic_spoil(weft_dice *d, weft_synthetic_shot *shot);

#endif
