/** Facts of texels that change, which test_texture_control runs. */
#ifndef TESTS_VULKAN_CONTROL_RELOAD_H
#define TESTS_VULKAN_CONTROL_RELOAD_H

void changed_tiles_are_copied_again_in_place(void **state);
void mip_tails_and_all_tiles_are_copied_again(void **state);
void a_reload_that_fails_keeps_the_old_texels(void **state);
void a_refused_reload_of_a_mip_tail_is_tried_again(void **state);
void given_up_tiles_are_tried_again_after_a_change(void **state);
void a_replaced_source_is_in_use_until_its_reads_end(void **state);
void waits_end_with_reads_and_ask_for_frames(void **state);
void waits_tell_of_failures_and_of_requests_that_are_over(void **state);
void sources_of_another_shape_are_refused(void **state);
void equal_tiles_get_pages_of_their_own(void **state);
void reloads_survive_every_refused_allocation(void **state);

#endif /* TESTS_VULKAN_CONTROL_RELOAD_H */
