foreach(name clock encoding error html_text json_text
        maths nearest number order report summary text_cursor
        text_diff utf8 watch yaml yaml_edit yaml_quote)
  abbe_test(${name} cpu abbe_base)
endforeach()
abbe_test(file cpu WRAPPED abbe_base)
target_link_options(test_file PRIVATE LINKER:--wrap=poll)
