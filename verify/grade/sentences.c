/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The table comes first; what reads it stands below.
 */
#include "verify/grade/sentences.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "verify/grade/place.h"

/* {scene} where, {measured} in percent of what is expected, {low} and {high} its interval, {margin} what all points ask for, {shown} what was
 * shown, {tile} {tile_measured} the worst part of the image, {samples} a pixel. */
static const lc_sentence table[] = {
    /* kind descriptor */
    {"compiled", "it compiles, and claims what is asked for: {language}"},
    {"claims_less", "it does not claim {missing}, which this assignment asks for: see the descriptor at the end of your file"},
    /* kind finite */
    {"finite", "no sample of {paths} was NaN, infinite, negative or above 1e60, over {scene}"},
    {"bad_sample", "{count} samples are NaN, infinite, negative or above 1e60 over {scene}: the first is ({red}, {green}, {blue}) at "
                   "pixel {x},{y}, sample {sample}, seed {seed}"},
    /* means */
    {"right", "{scene}: measured {measured} of the light that is expected, between {low} and {high}; all points ask for 100% +- {margin}"},
    {"right_exactly", "{scene}: every pixel has exactly the light that is expected"},
    {"near", "{scene}: measured {measured}, between {low} and {high}: shown within {shown} of what is expected, all points ask for {margin}"},
    {"open", "{scene}: measured {measured}, between {low} and {high} after {samples} samples a pixel: too noisy to show anything within "
             "{margin}"},
    {"wrong", "{scene}: measured {measured} of the light that is expected, between {low} and {high}, and shown wrong"},
    {"wrong_tile", "{scene}: measured {measured} of the light that is expected, between {low} and {high}; shown wrong most clearly in the "
                   "{tile}: {tile_measured} there"},
    {"wrong_pixel", "{scene}: pixel {x},{y} has {is}, expected exactly {should}"},
    {"light_from_nowhere", "{scene}: there is light where none is expected, most clearly in the {tile}"},
    {"black", "{scene}: not one sample of {paths} carries light"},
    {"dependent", "{scene}: its samples depend on each other, as if a generator were shared or seeded again: nothing can be measured"},
    {"wrong_but_near", "{scene}: measured {measured}, between {low} and {high}: shown wrong, but by less than 5%"},
    /* relations between scenes */
    {"relation_right", "{scene}: it agrees with itself: {relation}"},
    {"relation_wrong", "{scene}: it does not agree with itself over a scene that was changed: {measured} where 100% is expected, between {low} and "
                       "{high} ({relation})"},
    {"relation_near", "{scene}: it agrees with itself to within {shown} over a scene that was changed, all points ask for {margin}: {measured}, between "
                      "{low} and {high} ({relation})"},
    {"relation_open", "{scene}: {measured} of the same over a scene that was changed, between {low} and {high} after {samples} samples a pixel: too "
                      "noisy to show that it agrees with itself within {margin} ({relation})"},
    /* kind variance */
    {"variance_right", "{scene}: a sample varies {measured} as much as one of the method that is asked for, between {low} and {high}"},
    {"variance_high", "{scene}: a sample varies {measured} as much as one of the method that is asked for, between {low} and {high}; at most "
                      "{most}: is it that method?"},
    {"variance_low", "{scene}: a sample varies only {measured} as much as one of the method that is asked for, between {low} and {high}; at "
                     "least {least}: is it that method?"},
    {"variance_open", "{scene}: a sample varies {measured} as much as one of the method that is asked for, between {low} and {high}: too "
                      "uncertain to tell"},
    {"variance_wrong", "{scene}: noise counts of right samples only: the mean of these is {mean} of the light that is expected, shown wrong most "
                       "clearly in the {tile}"},
    {"variance_unshown", "{scene}: a sample varies {measured} as much as one of the method that is asked for, but the mean of these samples, {mean} "
                         "of what is expected, is not shown right within {margin}"},
    /* kinds rays, numbers and work */
    {"rays_right", "{scene}: a sample follows {measured} as many rays as one of the method that is asked for, between {low} and {high}"},
    {"rays_high", "{scene}: a sample follows {measured} as many rays as one of the method that is asked for, between {low} and {high}; at most "
                  "{most}: are several paths averaged in one sample?"},
    {"rays_low", "{scene}: a sample follows only {measured} as many rays as one of the method that is asked for, between {low} and {high}; at "
                 "least {least}: what stands between two points, and what a path meets, is asked of the scene"},
    {"rays_open", "{scene}: a sample follows {measured} as many rays as one of the method that is asked for, between {low} and {high}: too "
                  "uncertain to tell"},
    {"numbers_right", "{scene}: a sample draws {measured} as many random numbers as one of the method that is asked for, between {low} and {high}"},
    {"numbers_high", "{scene}: a sample draws {measured} as many random numbers as one of the method that is asked for, between {low} and {high}; "
                     "at most {most}: are several paths averaged in one sample?"},
    {"numbers_low", "{scene}: a sample draws only {measured} as many random numbers as one of the method that is asked for, between {low} and "
                    "{high}; at least {least}: does all that is random come from lc_next()?"},
    {"numbers_open", "{scene}: a sample draws {measured} as many random numbers as one of the method that is asked for, between {low} and {high}: "
                     "too uncertain to tell"},
    {"work_right", "{scene}: for the same noise it follows {measured} as many rays as the method that is asked for, between {low} and {high}"},
    {"work_high", "{scene}: for the same noise it follows {measured} as many rays as the method that is asked for, between {low} and {high}; at most "
                  "{most}: is it that method?"},
    {"work_low", "{scene}: for the same noise it follows only {measured} as many rays as the method that is asked for, between {low} and {high}; at "
                 "least {least}: is it that method?"},
    {"work_open", "{scene}: for the same noise it follows {measured} as many rays as the method that is asked for, between {low} and {high}: too "
                  "uncertain to tell"},
    {"cost_wrong", "{scene}: what samples cost is counted of right ones only: the mean of these is {mean} of the light that is expected, shown "
                   "wrong most clearly in the {tile}"},
    {"cost_unshown", "{scene}: what samples cost is counted of right ones only: the mean of these, {mean} of what is expected, is not shown right "
                     "within {margin}"},
    /* how it ended */
    {"ended_RTE", "{scene}: it died: {reason}"},
    {"ended_TLE", "{scene}: it took too long: {reason}"},
    {"ended_MLE", "{scene}: its memory was full: {reason}"},
    {"ended_OLE", "{scene}: it printed too much: {reason}"},
    {"ended_IR", "{scene}: it ended before its work was done: {reason}"},
    {"fault", "the grader is at fault, not your file: {reason}; grade again"},
    {"skipped", "left out, because `{because}` did not pass"},
    {"no_compile", "it cannot be graded: {reason}"},
    /* of a renderer, by its images */
    {"images_claimed", "it runs, and claims what is asked for"},
    {"images_claim_less", "its --describe does not name all materials, lights or bounces that are asked for"},
    {"images_finite", "it renders; no pixel is NaN, infinite or negative"},
    {"images_left_out", "left out: images of a renderer cannot tell"},
    {"images_bad", "{why}"},
    {"images_missing", "{folder}: {count} images, where {least} are needed, each of a seed of its own"},
    /* words in others */
    {"word_tile", "{width} x {height} pixels at {x},{y}"},
    {"word_bounce", "{count} bounce"},
    {"word_bounces", "{count} bounces"},
    /* what is withheld */
    {"withheld", "scene, numbers and the command that reproduces this are not shown until {until}"},
    {"withheld_ever", "scene, numbers and the command that reproduces this are not shown: another seed draws another scene"},
    {"withheld_undated", "scene, numbers and the command that reproduces this are not shown until the course publishes them"},
    {"hidden_passed", "right"},
    {"hidden_partial", "not shown as near as all points ask for"},
    {"hidden_failed", "wrong"},
    /* hints */
    {"hint_category", "what is wrong has to do with {category}"},
    {"hint_name", "{hint}"},
    /* the text besides: in the order of lc_label */
    {"label_hint", "hint"},
    {"label_pictures", "pictures"},
    {"label_again", "again"},
    {"label_ungradable", "ungradable, which costs no attempt"},
    {"label_printed", "your file printed, which counts for nothing"},
    {"label_fault", "no score: the grader is at fault, not your file. Grade again."},
    {"label_score", "score {score} of {points}"},
    {"label_late", "{earned}, less {penalty}: days late: {days}"},
    {"label_pending", "not judged yet"},
    {"label_incomplete", "not all tests are judged yet"},
    {"label_compiler", "the compiler says"},
    {"label_seed", "seed {seed}, jail: {jail}"},
};
enum { COUNT = sizeof table / sizeof table[0] };

struct lc_sentences {
    char *own[COUNT]; /* NULL: the table's */
};

static int index_of(const char *id)
{
    for (int i = 0; i < COUNT; ++i)
        if (strcmp(table[i].id, id) == 0)
            return i;
    return -1;
}

const char *lc_sentence_text(const lc_sentences *sentences, const char *id)
{
    int i = index_of(id);
    return i < 0 ? "" : sentences && sentences->own[i] ? sentences->own[i] : table[i].text;
}

/* Each {word} of the text is one of the program's sentence. */
static lc_status check_words(const lc_place *place, const char *text, const char *original, lc_error *err)
{
    for (const char *open = strchr(text, '{'); open; open = strchr(open + 1, '{')) {
        char word[64];
        size_t length = strcspn(open, "}");
        if (!open[length] || length + 2 > sizeof word)
            return lc_place_fail(err, place, "a { without its }");
        memcpy(word, open, length + 1);
        word[length + 1] = 0;
        if (!strstr(original, word))
            return lc_place_fail(err, place, "unknown word %s; the sentence reads: %s", word, original);
    }
    return LC_OK;
}

static lc_status replace(lc_sentences *s, const lc_place *root, const char *id, lc_error *err)
{
    lc_place place = lc_place_key(root, id);
    int i = index_of(id);
    char text[512];
    if (i < 0)
        return lc_place_fail(err, &place, "there is no sentence of this name: `lightcheck assignment sentences` lists them");
    lc_status status = lc_place_string(text, sizeof text, &place, 1, err);
    if (status == LC_OK)
        status = check_words(&place, text, table[i].text, err);
    if (status != LC_OK)
        return status;
    s->own[i] = malloc(strlen(text) + 1);
    if (!s->own[i])
        return lc_fail(err, LC_FAULT, "out of memory for the sentences");
    memcpy(s->own[i], text, strlen(text) + 1);
    return LC_OK;
}

lc_status lc_sentences_open(lc_sentences **out, const char *path, lc_error *err)
{
    lc_json_file file;
    const char *id;
    json_t *value;
    *out = calloc(1, sizeof **out);
    if (!*out)
        return lc_fail(err, LC_FAULT, "out of memory for the sentences");
    if (!path)
        return LC_OK;
    lc_status status = lc_json_open(&file, path, err);
    if (status == LC_OK) {
        lc_place root = lc_place_root(&file);
        json_object_foreach(file.root, id, value)
            if (status == LC_OK)
                status = replace(*out, &root, id, err);
        lc_json_close(&file);
    }
    if (status != LC_OK) {
        lc_sentences_close(*out);
        *out = NULL;
    }
    return status;
}

void lc_sentences_close(lc_sentences *sentences)
{
    for (int i = 0; sentences && i < COUNT; ++i)
        free(sentences->own[i]);
    free(sentences);
}

void lc_words_set(lc_words *words, const char *name, const char *format, ...)
{
    int i = 0;
    while (i < words->count && strcmp(words->items[i].name, name) != 0)
        ++i;
    if (i == LC_MOST_WORDS)
        return;
    words->count += i == words->count;
    words->items[i].name = name;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(words->items[i].text, sizeof words->items[i].text, format, arguments);
    va_end(arguments);
}

const char *lc_say(char *out, size_t size, const lc_sentences *sentences, const char *id, const lc_words *words)
{
    size_t used = 0;
    for (const char *at = lc_sentence_text(sentences, id); *at && used + 1 < size;) {
        const char *text = NULL;
        size_t length = *at == '{' ? strcspn(at, "}") : 0;
        for (int i = 0; length && i < words->count; ++i)
            if (strlen(words->items[i].name) == length - 1 && strncmp(words->items[i].name, at + 1, length - 1) == 0)
                text = words->items[i].text;
        if (!text) {
            out[used++] = *at++;
            continue;
        }
        at += length + 1;
        for (; *text && used + 1 < size; ++text)
            out[used++] = *text;
    }
    out[used] = 0;
    return out;
}

void lc_sentences_print(FILE *out)
{
    json_t *object = json_object();
    for (int i = 0; i < COUNT; ++i)
        json_object_set_new(object, table[i].id, json_string(table[i].text));
    json_dumpf(object, out, JSON_INDENT(2) | JSON_PRESERVE_ORDER);
    fputc('\n', out);
    json_decref(object);
}
