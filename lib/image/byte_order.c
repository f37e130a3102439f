#include "image/byte_order.h"

void slc_reverse_words(void *bytes, size_t size, uint32_t word_size)
{
    unsigned char *word = bytes;
    for (size_t done = 0; done < size; done += word_size, word += word_size)
        for (uint32_t i = 0; i < word_size / 2; i++) {
            unsigned char low = word[i];
            word[i] = word[word_size - 1 - i];
            word[word_size - 1 - i] = low;
        }
}
