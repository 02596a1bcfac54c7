#include "cli/view/picture/view_show.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

struct abbe_view_table {
  pthread_t thread;
  const abbe_display *display;
  _Atomic(abbe_display_table *) made;
};

static void *make(void *user) {
  abbe_view_table *table = user;
  abbe_display_table *made = NULL;
  if (abbe_display_table_make(table->display, &made, NULL) == ABBE_OK)
    atomic_store(&table->made, made);
  return NULL;
}

abbe_view_table *abbe_view_table_begin(const abbe_display *display) {
  abbe_view_table *table = malloc(sizeof *table);
  if (table == NULL) return NULL;
  table->display = display;
  atomic_init(&table->made, NULL);
  if (pthread_create(&table->thread, NULL, make, table) == 0) return table;
  free(table);
  return NULL;
}

const abbe_display_table *abbe_view_table_get(const abbe_view_table *table) {
  return table != NULL ? atomic_load(&table->made) : NULL;
}

void abbe_view_table_free(abbe_view_table *table) {
  if (table == NULL) return;
  pthread_join(table->thread, NULL);
  abbe_display_table_free(atomic_load(&table->made));
  free(table);
}
