/* A capture small enough to be repeated many times: 5 views x 5 lights, 96 x 96 pixels. */
#ifndef WEFT_TESTS_SMALL_SESSION_H
#define WEFT_TESTS_SMALL_SESSION_H

#include "tests/support/virtual_session.h"

enum { SMALL_SHOTS = 25, SMALL_SIZE = 96 };

/* Writes its plan to plan.csv in the current folder. The folder of the session is "session". */
virtual_session small_session_request(void);

/* Asserts that the session in `folder` is whole: the journal names every shot once in complete lines, every photograph
 * matches size and checksum and can be read, and nothing else lies beside them. */
void small_session_assert_whole(const char *folder);

/* CRC-32 over all photographs in the order of the plan. */
uint32_t small_session_crc(const char *folder);

/* Complete lines of the journal; 0 where there is none. */
int small_session_journal_lines(const char *folder);

#endif
