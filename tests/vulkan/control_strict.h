/** Facts of strict mode, which test_texture_control runs. */
#ifndef TESTS_VULKAN_CONTROL_STRICT_H
#define TESTS_VULKAN_CONTROL_STRICT_H

void unpaired_frames_are_reported(void **state);
void frames_that_are_never_signaled_are_reported_once(void **state);
void a_semaphore_that_is_late_by_a_moment_is_waited_for(void **state);
void frames_without_feedback_are_reported(void **state);
void exhausted_heaps_are_reported(void **state);
void sources_in_use_are_reported_and_kept(void **state);

#endif /* TESTS_VULKAN_CONTROL_STRICT_H */
