foreach(name error file report tally encoding nearest number text_cursor text_diff html_text yaml
        yaml_edit yaml_quote)
  abbe_test(${name} cpu abbe_base)
endforeach()
target_link_options(test_file PRIVATE LINKER:--wrap=poll)
