foreach(name error foreign_text
        number report
        text yaml yaml_edit)
  abbe_test(${name} cpu abbe_base)
endforeach()
abbe_test(file cpu WRAPPED abbe_base)
target_link_options(test_file PRIVATE LINKER:--wrap=poll)
