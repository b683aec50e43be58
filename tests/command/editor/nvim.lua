-- A session as Neovim has it, with its plug-in for debug adapters, nvim-dap.
--
--   nvim --headless -u NONE --cmd 'set rtp^=NVIM-DAP' -c 'luafile nvim.lua'
--
-- CC67_COMMAND is the command, CC67_FOLDER has one.c and two.c.
local command, folder = vim.env.CC67_COMMAND, vim.env.CC67_FOLDER
local one, two = folder .. '/one.c', folder .. '/two.c'

local dap = require('dap')
dap.adapters.cc67 = { type = 'executable', command = command, args = { 'debug', '--dap' } }

local stops, said, ended = {}, '', false
dap.listeners.after.event_stopped.test = function(_, body) table.insert(stops, body) end
dap.listeners.after.event_output.test = function(_, body)
  if body.category == 'stdout' then said = said .. body.output end
end
dap.listeners.after.disconnect.test = function() ended = true end

local function wait(what, condition)
  assert(vim.wait(120000, condition, 10), 'no ' .. what)
end

local function same(found, expected)
  assert(vim.deep_equal(found, expected), vim.inspect(found) .. ' is not ' .. vim.inspect(expected))
end

--- Asks the adapter something; what it answers.
local function ask(request, arguments)
  local done, failed, answer = false, nil, nil
  dap.session():request(request, arguments, function(problem, response)
    done, failed, answer = true, problem, response
  end)
  wait(request, function() return done end)
  assert(not failed, vim.inspect(failed))
  return answer
end

--- Sets the breakpoint of a line, or takes it away.
local function toggle(file, line, condition)
  vim.cmd('edit ' .. file)
  vim.api.nvim_win_set_cursor(0, { line, 0 })
  dap.toggle_breakpoint(condition)
end

--- Lets the board go; why and where it stops, and the innermost call.
local function until_stop(go)
  local before = #stops
  go()
  wait('stop', function() return #stops > before end)
  local stop = stops[#stops]
  local frame = ask('stackTrace', { threadId = stop.threadId }).stackFrames[1]
  if not frame then return { stop.reason } end
  -- The plug-in has asked for the same, and is ready then.
  wait('frame', function()
    local current = dap.session().current_frame
    return current and current.id == frame.id and current.line == frame.line
  end)
  return { stop.reason, stop.threadId, frame.source.name .. ':' .. frame.line }, frame, stop
end

local function value(expression, frame)
  return ask('evaluate', { expression = expression, frameId = frame.id, context = 'hover' }).result
end

local function session()
  -- Breakpoints in two threads, one of them with a condition; old versions of Neovim confuse those of two files.
  toggle(two, 9)
  local stop, frame = until_stop(function()
    dap.run({ type = 'cc67', request = 'launch', name = 'Debug', programs = { '1:' .. one, '2:' .. two }, O = 0 })
  end)
  same(stop, { 'breakpoint', 2, 'two.c:9' })
  toggle(two, 9)
  toggle(one, 15, 'count == 3')
  stop, frame = until_stop(dap.continue)
  same(stop, { 'breakpoint', 1, 'one.c:15' })
  same(value('count', frame), '3')

  -- What changes a variable.
  local info = ask('dataBreakpointInfo', { name = 'total' })
  ask('setDataBreakpoints', { breakpoints = { { dataId = info.dataId } } })
  toggle(one, 15)
  local what
  stop, frame, what = until_stop(dap.continue)
  same(stop[1], 'data breakpoint')
  assert(what.text:match('^total: 3 → 6, written by thread 1'), what.text)
  ask('setDataBreakpoints', { breakpoints = {} })

  -- Forward over a printf and a move, and back.
  toggle(one, 18)
  until_stop(dap.continue)
  until_stop(dap.step_over)
  stop = until_stop(dap.step_over)
  same(stop, { 'step', 1, 'one.c:20' })
  stop, frame = until_stop(dap.step_back)
  same({ stop[3], value('ch0->Dest', frame) }, { 'one.c:19', '0' })
  stop = until_stop(dap.step_back)
  same(stop[3], 'one.c:18')
  toggle(one, 18)

  -- A trap, and the end.
  stop = until_stop(dap.continue)
  same(stop, { 'exception', 1, 'one.c:23' })
  -- The last line is on its way to the PC still.
  same(said, 'total 10\n')
  stop = until_stop(dap.reverse_continue)
  same(stop[1], 'step')
  dap.disconnect()
  wait('end', function() return ended or not dap.session() end)
end

local fine, problem = xpcall(session, debug.traceback)
if not fine then
  io.stderr:write(problem .. '\n')
  vim.cmd('cquit 1')
end
vim.cmd('qall!')
