/** Texts that Dear ImGui draws, for tests. */
#ifndef SLUICE_TESTS_VIEW_LOG_TEXT_H
#define SLUICE_TESTS_VIEW_LOG_TEXT_H

#ifdef __cplusplus
extern "C" {
#endif

/** Begins to record the texts of widgets, also of those out of sight. Call after ui_begin_frame. */
void log_text_begin(void);
/** Returns the texts, valid until the next call. */
const char *log_text_end(void);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_TESTS_VIEW_LOG_TEXT_H */
