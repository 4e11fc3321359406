/* The journal of a session: one JSON object a line, appended when a photograph is complete. */
#ifndef WEFT_BTF_SESSION_JOURNAL_H
#define WEFT_BTF_SESSION_JOURNAL_H

#include "btf/session/session.h"

/* Fills session->record from the journal in session->folder; no journal means no photographs. A shot named twice keeps
 * its last line. A last line without its newline is ignored. Errors: WEFT_BAD_INPUT naming file and line. */
weft_code weft_journal_read(weft_session *session, weft_error *error);

#endif
